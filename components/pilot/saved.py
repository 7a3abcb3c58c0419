"""The pilot's progress as text, checked when it is read back."""

from __future__ import annotations

import json
from dataclasses import asdict

from components.pilot.progress import Progress
from runtime.params import ConfigurationError, build

_VERSION = 1


def to_text(progress: Progress) -> str:
    """JSON; equal progress gives equal text."""
    return json.dumps({"version": _VERSION, "progress": asdict(progress)}, sort_keys=True, allow_nan=False)


def from_text(text: str) -> Progress:
    """The progress that `to_text` wrote.

    Raises:
        ValueError: it is none, or not a valid one; says why.
    """
    try:
        saved = json.loads(text)
        if not isinstance(saved, dict) or saved.get("version") != _VERSION:
            raise ValueError(f"pilot state must have version {_VERSION}")
        return build(Progress, saved["progress"], "pilot state")
    except (KeyError, TypeError, RecursionError, ConfigurationError) as error:
        raise ValueError(f"pilot state is incomplete or mistyped: {error}") from error
