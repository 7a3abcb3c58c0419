"""One component of a running host: its process now, and when the next one is due."""

from __future__ import annotations

import signal
import time
from collections.abc import Sequence
from dataclasses import dataclass

from runtime.child import Child
from runtime.device import lay_to_rest
from runtime.restart import Restarts
from runtime.system import ComponentSpec

_POLL_S = 0.01


@dataclass(frozen=True)
class Death:
    """A process that ended although nobody had asked it to."""

    name: str
    exit_code: int
    words: str
    restarted: bool


@dataclass
class Member:
    """Belongs to the supervisor's thread."""

    spec: ComponentSpec
    restarts: Restarts
    child: Child
    due_s: float | None = None
    """Monotonic time of the next start, while it is down."""


def kill_who_stays(members: Sequence[Member], grace_s: float) -> list[Death]:
    """Ask these processes to end, wait, kill those that have not, and bring the devices of the killed to rest.

    Args:
        members: running or ended.
        grace_s: until SIGKILL, and after it.

    Returns:
        Who had to be killed.
    """
    for member in members:
        member.child.send(signal.SIGTERM)
    if _have_ended(members, grace_s):
        return []
    late = [member for member in members if member.child.exit_code is None]
    for member in late:
        member.child.send(signal.SIGKILL)
    _have_ended(late, grace_s)
    for member in late:
        if member.child.exit_code == -signal.SIGKILL:
            lay_to_rest(member.spec)
    words = f"did not stop within {grace_s} s and was killed"
    return [Death(m.spec.name, -signal.SIGKILL, f"{m.spec.name} {words}", restarted=False) for m in late]


def _have_ended(members: Sequence[Member], timeout_s: float) -> bool:
    deadline_s = time.monotonic() + timeout_s
    while any(member.child.exit_code is None for member in members):
        if time.monotonic() >= deadline_s:
            return False
        time.sleep(_POLL_S)
    return True
