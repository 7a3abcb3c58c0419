"""What a running system leaves for those who join it later: its description, beside its logs."""

from __future__ import annotations

import os
import time
from pathlib import Path

import zenoh

from runtime.assignment import Assignment
from runtime.params import ConfigurationError
from runtime.runfile import Run

_FILE = "session.json"
_QUIET_S = 0.3
_POLL_S = 0.005


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


def await_links(session: zenoh.Session, components: int, timeout_s: float = 2.0) -> None:
    """Wait until a session that has just joined is linked to its peers directly.

    Until then the router passes messages on, and some are lost when it stops doing so (seen: ten milliseconds).

    Args:
        session: has declared nothing yet.
        components: processes that are known to be there; fewer if one process speaks for several of them.
        timeout_s: go on after this in any case.
    """
    deadline_s = time.monotonic() + timeout_s
    linked, since_s = -1, 0.0
    while (now_s := time.monotonic()) < deadline_s:
        count = len(list(session.info.peers_zid()))
        if count != linked:
            linked, since_s = count, now_s
        if linked >= components or now_s - since_s > _QUIET_S:
            return
        time.sleep(_POLL_S)
