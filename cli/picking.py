"""Options that choose topics, the same for `berth record` and `berth play`."""

from __future__ import annotations

from typing import Annotated

import typer

from runtime.selection import Selection

TOPICS = Annotated[str, typer.Option("--topics", help="Only these keys below the realm, with commas between.")]
INCLUDE = Annotated[str, typer.Option("-e", "--regex", help="Only keys in which this regular expression is found.")]
EXCLUDE = Annotated[str, typer.Option("-x", "--exclude", help="No keys in which this regular expression is found.")]


def selection(topics: str, include: str, exclude: str) -> Selection:
    """The options as one.

    Raises:
        ConfigurationError: a pattern is no regular expression.
    """
    return Selection(tuple(key for key in topics.split(",") if key), include, exclude)
