"""Lets something pass now and then. Pure: the clock's reading is an argument."""

from __future__ import annotations


class Rate:
    """At most one in each period."""

    def __init__(self, period_ns: int) -> None:
        """The first one passes."""
        self.period_ns = period_ns
        self._next_ns: int | None = None

    def passes(self, now_ns: int) -> bool:
        """Whether one may pass now; time that runs backwards begins anew."""
        if self._next_ns is None or now_ns >= self._next_ns or now_ns < self._next_ns - 2 * self.period_ns:
            self._next_ns = now_ns + self.period_ns
            return True
        return False
