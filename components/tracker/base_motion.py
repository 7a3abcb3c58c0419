"""What the base does with the commands it applied: latency, then a ramp to the new speeds."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

PENDING = 8
"""Commands that may wait for the base's latency to pass."""


class Limits(NamedTuple):
    """How fast the base's speeds change."""

    acceleration_mps2: float
    turn_acceleration_radps2: float


def ramp(rate: float, target: float, limit: float, dt_s: float) -> tuple[float, float]:
    """(rate, its integral) after dt_s of approaching a target at a constant acceleration `limit`."""
    if rate == target:
        return target, target * dt_s
    gap = target - rate
    ramp_s = min(abs(gap) / limit, dt_s)
    reached = target if abs(gap) <= limit * dt_s else rate + (limit if gap > 0.0 else -limit) * dt_s
    return reached, 0.5 * (rate + reached) * ramp_s + target * (dt_s - ramp_s)


@dataclass
class Command:
    """Speeds that the base approaches from `time_ns` on."""

    time_ns: int = 0
    v_mps: float = 0.0
    omega_radps: float = 0.0


@dataclass
class BaseMotion:
    """Speeds of the base as far as its commands tell, and how far it has come."""

    time_ns: int = -1
    v_mps: float = 0.0
    omega_radps: float = 0.0
    way_m: float = 0.0
    """Signed length driven."""
    heading_rad: float = 0.0
    """Turned to the left."""
    target_v_mps: float = 0.0
    target_omega_radps: float = 0.0
    pending: list[Command] = field(default_factory=list)

    def command(self, time_ns: int, v_mps: float, omega_radps: float) -> None:
        """Approach these speeds from `time_ns` on."""
        del self.pending[: max(0, len(self.pending) - PENDING + 1)]
        self.pending.append(Command(time_ns, v_mps, omega_radps))

    def advance(self, time_ns: int, limits: Limits) -> None:
        """Move on to `time_ns`, through the commands that become due on the way."""
        if self.time_ns < 0:
            self.time_ns = time_ns
        while self.pending and self.pending[0].time_ns <= time_ns:
            due = self.pending.pop(0)
            self._glide(due.time_ns, limits)
            self.target_v_mps, self.target_omega_radps = due.v_mps, due.omega_radps
        self._glide(time_ns, limits)

    def ahead(self, dt_s: float, limits: Limits) -> tuple[float, float]:
        """(way_m, turn_rad) of the next dt_s, if no further command comes."""
        targets = (self.target_v_mps, self.target_omega_radps)
        future = BaseMotion(self.time_ns, self.v_mps, self.omega_radps, 0.0, 0.0, *targets, self.pending[:])
        future.advance(self.time_ns + round(dt_s * 1e9), limits)
        return future.way_m, future.heading_rad

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves and nothing is about to."""
        moves = self.v_mps or self.omega_radps or self.target_v_mps or self.target_omega_radps
        return not moves and not any(command.v_mps or command.omega_radps for command in self.pending)

    def _glide(self, time_ns: int, limits: Limits) -> None:
        dt_s = max(time_ns - self.time_ns, 0) * 1e-9
        self.time_ns = max(time_ns, self.time_ns)
        self.v_mps, way_m = ramp(self.v_mps, self.target_v_mps, limits.acceleration_mps2, dt_s)
        self.omega_radps, turn_rad = ramp(
            self.omega_radps, self.target_omega_radps, limits.turn_acceleration_radps2, dt_s
        )
        self.way_m += way_m
        self.heading_rad += turn_rad
