"""Real faults for real processes: signals, limits, and a lit fuse."""

from __future__ import annotations

import os
import resource
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

_STOPPED_S, _RUNNING_S = 0.04, 0.01
"""Of a process that is slowed down: a fifth of the processor."""
_NO_MORE = 4096
"""Bytes of address space: nothing that is not there already."""


def kill(pid: int) -> None:
    """End it hard."""
    os.kill(pid, signal.SIGKILL)


def pause(pid: int, lasts_s: float) -> None:
    """Stop it and let it go on."""
    _stop_for(pid, lasts_s)


def slow(pid: int, lasts_s: float) -> None:
    """Give it a fifth of its time."""
    until_s = time.monotonic() + lasts_s
    while time.monotonic() < until_s:
        _stop_for(pid, _STOPPED_S)
        time.sleep(_RUNNING_S)


def _stop_for(pid: int, seconds: float) -> None:
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGSTOP)
        try:
            time.sleep(seconds)
        finally:
            os.kill(pid, signal.SIGCONT)


def starve(pid: int) -> Callable[[], None]:
    """Let it have no more memory than it has; returns what ends that."""
    _, hard = resource.prlimit(pid, resource.RLIMIT_AS)
    resource.prlimit(pid, resource.RLIMIT_AS, (_NO_MORE, hard))

    def feed() -> None:
        with suppress(ProcessLookupError):
            resource.prlimit(pid, resource.RLIMIT_AS, (hard, hard))

    return feed


def light(fuse: Path) -> Callable[[], None]:
    """Let a component fail on its next message; returns what puts the fuse out."""
    fuse.touch()
    return lambda: fuse.unlink(missing_ok=True)
