"""One pass of a player through its log: new run ids, sequences from 0. Time never runs backwards inside one."""

from __future__ import annotations

from runtime.recording import Logged
from runtime.wire import Stamp, new_run


class Epoch:
    """Gives each logged message the stamp it is played with."""

    def __init__(self, number: int) -> None:
        """The epoch of this number; nothing was played in it."""
        self.number = number
        self._runs: dict[int, int] = {}
        self._first: dict[tuple[str, int], int] = {}

    def stamp(self, logged: Logged, capture_ns: int) -> Stamp:
        """Run, sequence and capture time to play a message with.

        A hole in the logged sequence stays one: whoever listens shall count it as lost.
        """
        run = self._runs.get(logged.run) or self._renew(logged.run)
        first = self._first.setdefault((logged.topic, logged.run), logged.sequence)
        return Stamp(run, max(0, logged.sequence - first), capture_ns)

    def _renew(self, logged_run: int) -> int:
        self._runs[logged_run] = new_run()
        return self._runs[logged_run]
