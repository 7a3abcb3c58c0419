"""Tick schedules and session clocks; wall time comes in as an argument."""

from __future__ import annotations

from dataclasses import dataclass


class Ticks:
    """When a component's timer is due. The first tick is due at time 0; late ticks coalesce into one."""

    def __init__(self, hz: float) -> None:
        self._period_ns = round(1e9 / hz)
        self.next_ns = 0
        self.coalesced = 0

    def due(self, time_ns: int) -> bool:
        """Whether a tick is due at `time_ns`; asks for the next one after it."""
        if time_ns < self.next_ns:
            return False
        missed = (time_ns - self.next_ns) // self._period_ns
        self.coalesced += missed
        self.next_ns += (missed + 1) * self._period_ns
        return True


@dataclass(frozen=True, slots=True)
class PacedClock:
    """Session time that follows the host's monotonic clock at a pace; the same for all processes of the host."""

    origin_ns: int
    """Monotonic time at which session time was 0."""
    pace: float
    """Session seconds per wall second."""

    def time_ns(self, monotonic_ns: int) -> int:
        """Session time."""
        return round((monotonic_ns - self.origin_ns) * self.pace)

    def wall_s(self, time_ns: int, monotonic_ns: int) -> float:
        """Wall seconds from now until session time `time_ns`; negative if it has passed."""
        return (time_ns / self.pace - (monotonic_ns - self.origin_ns)) * 1e-9
