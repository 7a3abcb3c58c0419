"""What a running system leaves for those who join it later: its description, beside its logs."""

from __future__ import annotations

import os
from pathlib import Path

from runtime.assignment import Assignment
from runtime.params import ConfigurationError
from runtime.runfile import Run

_FILE = "session.json"


def describe(run: Run, session: Assignment) -> None:
    """Write a session's resolved launch file and its clock's origin into the run's directory."""
    path = Path(run.directory) / _FILE
    draft = path.with_suffix(".new")
    draft.write_text(session.to_json(), encoding="utf-8")
    os.replace(draft, path)  # noqa: PTH105  (atomic: nobody reads half of it)


def description(run: Run) -> Assignment:
    """What `describe` wrote.

    Raises:
        ConfigurationError: there is none yet, or the system is of another release.
    """
    path = Path(run.directory) / _FILE
    try:
        return Assignment.from_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, TypeError, KeyError):
        raise ConfigurationError(f"{path}: must describe the running system; is it of this release?") from None
