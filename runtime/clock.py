"""Session time, pure: every function takes the monotonic clock's reading as an argument."""

from __future__ import annotations

from dataclasses import dataclass

SECOND_NS = 1_000_000_000
LOG_SKEW_NS = 4 * SECOND_NS
"""In lockstep a recorder hears one component at most 16 frames (two seconds at 8 Hz) earlier than another."""


class TickSchedule:
    """When a component's `tick` is due: once a period of session time; late ticks coalesce and are counted."""

    def __init__(self, hz: float) -> None:
        """The first tick is due at time 0."""
        self.period_ns = round(SECOND_NS / hz)
        self.next_ns = 0
        self.coalesced = 0

    def due(self, time_ns: int) -> int | None:
        """The time of the one tick to hand over now, or None.

        Args:
            time_ns: session time; never decreasing.

        Returns:
            The latest boundary up to `time_ns`, if it was not handed over yet.
        """
        if time_ns < self.next_ns:
            return None
        boundary_ns = time_ns - time_ns % self.period_ns
        self.coalesced += (boundary_ns - self.next_ns) // self.period_ns
        self.next_ns = boundary_ns + self.period_ns
        return boundary_ns


@dataclass(frozen=True, slots=True)
class PacedClock:
    """Session time that follows a host's monotonic clock; equal in all processes that share `origin_ns`."""

    origin_ns: int
    """Monotonic time at which the session's time is 0."""
    pace: float = 1.0
    """Session seconds per wall second."""

    def session_ns(self, monotonic_ns: int) -> int:
        """Session time at a monotonic time; 0 before the origin."""
        return max(0, round((monotonic_ns - self.origin_ns) * self.pace))

    def monotonic_ns(self, session_ns: int) -> int:
        """The monotonic time at which the session's time is `session_ns`."""
        return self.origin_ns + round(session_ns / self.pace)


class FrameClock:
    """Session time in lockstep: the newest capture time handed over so far."""

    def __init__(self) -> None:
        """Time starts at 0."""
        self.now_ns = 0

    def advance(self, capture_ns: int) -> int:
        """Session time at the hand-over of a message of this capture time."""
        self.now_ns = max(self.now_ns, capture_ns)
        return self.now_ns


class LogTimes:
    """Session time under which a tap logs each message in lockstep: its capture time, however late the tap is.

    The tap's own clock would be the newest frame that it has heard of, and under load it hears one component two
    seconds before another. Three exceptions: in one channel time never runs backwards, so that sorting by log time
    keeps every sequence; who lags behind by more than the skew is logged there, so that sorting needs a bounded memory;
    and a new run that far back begins a new epoch, which comes after all that was before.
    """

    def __init__(self) -> None:
        """Nothing was logged."""
        self._newest_ns = 0
        self._floor_ns = 0
        self._channels: dict[tuple[str, int], int] = {}

    def log_ns(self, key: str, run: int, capture_ns: int) -> int:
        """Log time of the next message of a key and run."""
        self._newest_ns = max(self._newest_ns, capture_ns)
        oldest_ns = self._newest_ns - LOG_SKEW_NS
        if (key, run) not in self._channels and capture_ns < oldest_ns:
            self._floor_ns = self._newest_ns
        log_ns = max(capture_ns, self._channels.get((key, run), 0), oldest_ns, self._floor_ns)
        self._channels[key, run] = log_ns
        return log_ns


class Pacer:
    """Holds lockstep's next frame back until its wall time has come."""

    def __init__(self, pace: float) -> None:
        """The first frame asked for starts the clock."""
        self._pace = pace
        self._clock: PacedClock | None = None

    def wait_ns(self, capture_ns: int, monotonic_ns: int) -> int:
        """How long the frame of this capture time must wait; a late frame does not hurry those after it."""
        if self._clock is None:
            self._clock = PacedClock(monotonic_ns - round(capture_ns / self._pace), self._pace)
        wait_ns = self._clock.monotonic_ns(capture_ns) - monotonic_ns
        if wait_ns < 0:
            self._clock = PacedClock(self._clock.origin_ns - wait_ns, self._pace)
        return max(0, wait_ns)
