"""Sequence numbers of one port's publishers: what was lost, what came twice. Pure."""

from __future__ import annotations

from collections import OrderedDict

from runtime.wire import Refused

_RUNS = 64
"""Runs remembered, of all components where the publisher is not known; a restart has a new id, an old one never comes
back."""


class Sequences:
    """Follows the sequence of each run on one key."""

    def __init__(self) -> None:
        """Nothing was received yet."""
        self._next: OrderedDict[int, int] = OrderedDict()
        self.lost = 0

    def expect(self, run: int, first: int | None) -> None:
        """A run has been announced.

        Args:
            run: its id.
            first: sequence of its first message for us; None = whatever comes first, since it began before us.
        """
        if run not in self._next:
            self._next[run] = -1 if first is None else first
            while len(self._next) > _RUNS:
                self._next.popitem(last=False)

    def receive(self, run: int, sequence: int) -> None:
        """Note one message.

        Raises:
            Refused: nobody announced its run, or it came before.
        """
        expected = self._next.get(run)
        if expected is None:
            raise Refused(f"run {run:016x} was not announced")
        if sequence < expected:
            raise Refused(f"sequence {sequence} came after {expected - 1}")
        if expected >= 0:
            self.lost += sequence - expected
        self._next[run] = sequence + 1
