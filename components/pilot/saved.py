"""The pilot's progress as text, checked when it is read back."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import NamedTuple

from components.pilot.progress import Heard, Progress
from runtime.params import ConfigurationError, build

_VERSION = 1


class Saved(NamedTuple):
    """What is kept."""

    progress: Progress
    heard: Heard


def to_text(saved: Saved) -> str:
    """JSON; equal progress gives equal text."""
    parts = {name: asdict(part) for name, part in saved._asdict().items()}
    return json.dumps({"version": _VERSION, **parts}, sort_keys=True, allow_nan=False)


def from_text(text: str) -> Saved:
    """What `to_text` wrote.

    Raises:
        ValueError: it is none, or not a valid one; says why.
    """
    try:
        parts = json.loads(text)
        if not isinstance(parts, dict) or parts.get("version") != _VERSION:
            raise ValueError(f"pilot state must have version {_VERSION}")
        progress = build(Progress, parts["progress"], "pilot state: progress")
        return Saved(progress, build(Heard, parts["heard"], "pilot state: heard"))
    except (KeyError, TypeError, AttributeError, RecursionError, ConfigurationError) as error:
        raise ValueError(f"pilot state is incomplete or mistyped: {error}") from error
