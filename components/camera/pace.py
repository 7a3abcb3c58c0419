"""Which frames of a fast camera are passed on."""

from __future__ import annotations


class Pace:
    """Picks frames by their time, so many a second on the mean, none twice."""

    def __init__(self, hz: float) -> None:
        """The first frame is picked."""
        self._period_ns = round(1e9 / hz)
        self._due_ns: int | None = None
        self._newest_ns = -1

    def takes(self, time_ns: int) -> bool:
        """Whether the frame of this time, later than all before, is one of them."""
        if time_ns <= self._newest_ns:
            return False
        self._newest_ns = time_ns
        if self._due_ns is not None and time_ns < self._due_ns - self._period_ns // 16:
            return False
        planned_ns = time_ns if self._due_ns is None else self._due_ns
        # After a pause the rhythm begins anew; what was missed is not made up for.
        self._due_ns = self._period_ns + (planned_ns if time_ns - planned_ns < self._period_ns else time_ns)
        return True
