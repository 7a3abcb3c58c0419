"""`berth report FILE`: one HTML page about a session."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from runtime.params import ConfigurationError

FILE = Annotated[Path, typer.Argument(help="Recording (MCAP).")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Page to write; default: beside the recording.")]
POSTER = Annotated[Path | None, typer.Option(help="Also draw one picture of the session: a PNG to write.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def report(file: FILE, output: OUTPUT = None, poster: POSTER = None, as_json: JSON = False) -> None:
    """Write a page with the learning curve, paths, policy and tracking. Example: berth report recordings/sim.mcap."""
    page, numbers = write_report(file, output, poster)
    text = json.dumps({"report": str(page), **numbers}) if as_json else str(page)
    sys.stdout.write(text + "\n")


def write_report(file: Path, output: Path | None = None, poster: Path | None = None) -> tuple[Path, dict[str, int]]:
    """Read the session and write its page; matplotlib and numba are imported only here.

    Raises:
        ConfigurationError: the file is no session of ours, or the page can not be written.
    """
    from report.comparison import compare  # noqa: PLC0415
    from report.page import numbers, write  # noqa: PLC0415
    from report.poster import write as write_poster  # noqa: PLC0415
    from report.session import read  # noqa: PLC0415

    page = output or file.with_suffix(".html")
    session = read(file)
    comparison = compare(session.policies, session.launch.get("task", {})) if session.policies else None
    if poster is not None and comparison is None:
        raise ConfigurationError(f"{file}: must hold a policy to draw a poster of")
    try:
        write(session, page, comparison)
        if poster is not None and comparison is not None:
            write_poster(session, comparison, poster)
    except OSError as error:
        raise ConfigurationError(f"{error.filename or page}: can not be written: {error.strerror}") from None
    return page, dict(numbers(session))
