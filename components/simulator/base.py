"""The robot's base: a unicycle with latency, acceleration limits, a watchdog of its own and two bumpers."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

from components.simulator.params import Params
from docking import plant

BUMPER_RELEASE_M = 0.005
"""A bumper stays pressed until the robot is this far off table and wall."""
PENDING = 64
"""Commands that wait for their effect; older ones are dropped."""


class Twist(NamedTuple):
    """What the base is asked to do."""

    v_mps: float
    omega_radps: float


REST = Twist(0.0, 0.0)


@dataclass(slots=True)
class Pose:
    """Of the axle, world frame."""

    x_m: float
    y_m: float
    heading_rad: float

    def move(self, v_mps: float, omega_radps: float, dt_s: float) -> None:
        """Drive an arc."""
        self.x_m, self.y_m, self.heading_rad = plant.advance(
            self.x_m, self.y_m, self.heading_rad, v_mps, omega_radps, dt_s
        )

    @property
    def triple(self) -> tuple[float, float, float]:
        """(x_m, y_m, heading_rad)."""
        return self.x_m, self.y_m, self.heading_rad


class Base:
    """Moves only by what it was commanded."""

    def __init__(self, params: Params, pose: Pose) -> None:
        self._params = params
        self.pose = pose
        self.v_mps = 0.0
        self.omega_radps = 0.0
        self.bumper = False
        self.rear_bumper = False
        self._pending: deque[tuple[int, int, Twist]] = deque(maxlen=PENDING)
        """(time of its effect, of its arrival, command)."""
        self._wish = REST
        self._heard_ns: int | None = None

    def command(self, twist: Twist, arrival_ns: int) -> None:
        """Take a command; it acts after the latency. One that the base can not do is a command to stand still."""
        effect_ns = arrival_ns + round(self._params.command_latency_s * 1e9)
        self._pending.append((effect_ns, arrival_ns, twist if self._possible(twist) else REST))

    def _possible(self, twist: Twist) -> bool:
        """False for nan too."""
        return (
            abs(twist.v_mps) <= self._params.speed_limit_mps and abs(twist.omega_radps) <= self._params.turn_limit_radps
        )

    def place(self, pose: Pose) -> None:
        """Be there, at rest, with nothing commanded."""
        self.pose = pose
        self.v_mps = self.omega_radps = 0.0
        self.bumper = self.rear_bumper = False
        if self._pending:
            self._heard_ns = self._pending[-1][1]
        self._pending.clear()
        self._wish = REST

    def step(self, time_ns: int, dt_s: float) -> None:
        """Move from `time_ns` for `dt_s`."""
        while self._pending and self._pending[0][0] <= time_ns:
            _, self._heard_ns, self._wish = self._pending.popleft()
        if self._deaf(time_ns):
            self._wish = REST  # for good: what was wished before must not come back with the next command's arrival
        self.v_mps = _approach(self.v_mps, self._wish.v_mps, self._params.acceleration_mps2 * dt_s)
        self.omega_radps = _approach(
            self.omega_radps, self._wish.omega_radps, self._params.angular_acceleration_radps2 * dt_s
        )
        self._move(dt_s)

    def _deaf(self, time_ns: int) -> bool:
        """A world that stood still and catches up has not heard yet what came meanwhile."""
        heard = (arrival_ns for _, arrival_ns, _ in reversed(self._pending) if arrival_ns <= time_ns)
        heard_ns = next(heard, self._heard_ns)
        return heard_ns is None or time_ns - heard_ns > self._params.watchdog_s * 1e9

    def _move(self, dt_s: float) -> None:
        before_m = self.clearance_m(self.pose)
        ahead = Pose(*self.pose.triple)
        ahead.move(self.v_mps, self.omega_radps, dt_s)
        after_m = self.clearance_m(ahead)
        if after_m < 0.0 and after_m < before_m:
            self.bumper, self.rear_bumper = self.v_mps >= 0.0, self.v_mps < 0.0
            self.v_mps = 0.0
            ahead = Pose(*self.pose.triple)
            ahead.move(0.0, self.omega_radps, dt_s)
        elif after_m > BUMPER_RELEASE_M:
            self.bumper = self.rear_bumper = False
        self.pose = ahead

    @property
    def rear_range_m(self) -> float | None:
        """Free way behind, as the sensor reads it; None = there is no sensor."""
        reach_m, wall_m = self._params.rear_reach_m, self._params.wall_behind_m
        if reach_m == 0.0:
            return None
        slope = math.cos(self.pose.heading_rad)
        if wall_m == 0.0 or slope <= 0.0:
            return reach_m
        return min(max((self.pose.x_m + wall_m) / slope - self._params.robot_radius_m, 0.0), reach_m)

    def clearance_m(self, pose: Pose) -> float:
        """Gap between the robot's circle and the table's edge or the wall; negative inside."""
        wall_m = self._params.wall_behind_m
        table_m = self._from_table_m(pose)
        return min(table_m, pose.x_m + wall_m - self._params.robot_radius_m) if wall_m > 0.0 else table_m

    def _from_table_m(self, pose: Pose) -> float:
        p = self._params
        beyond_m = max(-p.edge_offset_m - pose.x_m, pose.x_m + p.edge_offset_m - p.table_depth_m)
        aside_m = abs(pose.y_m) - 0.5 * p.table_width_m
        return math.hypot(max(beyond_m, 0.0), max(aside_m, 0.0)) + min(max(beyond_m, aside_m), 0.0) - p.robot_radius_m


def _approach(value: float, target: float, step: float) -> float:
    return min(max(target, value - step), value + step)
