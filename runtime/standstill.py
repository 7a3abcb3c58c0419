"""Time stands still in lockstep while somebody is started again, or joins."""

from __future__ import annotations

import time

from runtime.outlet import Outlet
from runtime.wishes import PAUSE_S
from schemas.session_pb2 import Hold

_GUEST = "a guest"
"""Who asked for a pause, among the names of those for whom time is held."""


class Standstill:
    """For whom time is held; says so on the bus. Belongs to the supervisor's thread."""

    def __init__(self, outlet: Outlet) -> None:
        """Time goes on.

        Args:
            outlet: of the key that the world listens to.
        """
        self._outlet = outlet
        self._names: set[str] = set()
        self._paused_until_s = 0.0

    def __contains__(self, name: str) -> bool:
        """Whether time is held for this component."""
        return name in self._names

    def hold(self, name: str) -> None:
        """Hold time for a component."""
        self._names.add(name)
        self._say(name)

    def release(self, name: str) -> None:
        """Hold it no longer for this one."""
        self._names.discard(name)
        self._say(name)

    def pause(self) -> None:
        """Hold time for a guest, who may die: for `PAUSE_S` at most."""
        self._paused_until_s = time.monotonic() + PAUSE_S
        self.hold(_GUEST)

    def go_on(self) -> None:
        """The guest is done."""
        if _GUEST in self._names:
            self.release(_GUEST)

    def look(self) -> None:
        """End a pause that has lasted too long."""
        if time.monotonic() >= self._paused_until_s:
            self.go_on()

    def _say(self, name: str) -> None:
        self._outlet.put(Hold(active=bool(self._names), component=name), 0)
