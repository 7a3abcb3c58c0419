"""Where a player is in its log, and when each moment of it is due. Pure: the clock's reading is an argument."""

from __future__ import annotations

_LATE_NS = 100_000_000
"""Whoever holds the player back longer than this is not made to catch up."""


class Playhead:
    """A clock that can be started, paused and stepped."""

    def __init__(self, rate: float, *, paused: bool = False) -> None:
        """Stand at time 0.

        Args:
            rate: log seconds per wall second; 0 = as fast as possible.
            paused: let nothing pass before `toggle` or `step`.
        """
        self.rate = rate
        self.paused = paused
        self.time_ns = 0
        """Log time of the newest message that has passed."""
        self._steps = 0
        self._anchor: tuple[int, int] | None = None
        """Log time and the monotonic time at which it is due; None = from the next message on."""

    def seek(self, log_ns: int) -> None:
        """Go on from another time."""
        self.time_ns = log_ns
        self._anchor = None

    def toggle(self) -> None:
        """Pause, or go on."""
        self.paused = not self.paused
        self._steps = 0
        self._anchor = None

    def step(self) -> None:
        """Let one more message pass, and stand still."""
        if not self.paused:
            self.toggle()
        self._steps += 1

    def wait_ns(self, log_ns: int, monotonic_ns: int) -> int | None:
        """How long the next message must wait; None = until somebody says so.

        Args:
            log_ns: its time in the log.
            monotonic_ns: now.
        """
        if self.paused:
            return 0 if self._steps else None
        if self.rate == 0:
            return 0
        wait_ns = self.monotonic_ns(log_ns, monotonic_ns) - monotonic_ns
        if wait_ns < -_LATE_NS:
            self._anchor = (log_ns, monotonic_ns)
        return max(0, wait_ns)

    def monotonic_ns(self, log_ns: int, monotonic_ns: int) -> int:
        """The monotonic time at which a moment of the log is due; the first one asked for is due now."""
        if self._anchor is None:
            self._anchor = (log_ns, monotonic_ns)
        return self._anchor[1] + round((log_ns - self._anchor[0]) / (self.rate or 1.0))

    def passed(self, log_ns: int) -> None:
        """A message was played."""
        self.time_ns = max(self.time_ns, log_ns)
        if self.paused:
            self._steps -= 1
