"""Driving backwards is blind: what is known of the way behind, and how far back the robot has gone.

Range and bumper are what a robot has; the distance and the fence rest on odometry alone.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from components.base.ports import Params

REAR_BUMPER, REAR, REVERSE, FENCE = "rear-bumper", "rear", "reverse", "fence"
"""Reasons for a stop, as `Applied.commander` names them."""
_FORGET_M = 0.1
"""So far forwards, and the way back begins anew."""
_JUMP_M, _JUMP_MPS = 0.1, 2.0
"""Odometry that moves further than this, and faster, was set to another value; no robot moves so."""


class Reading(NamedTuple):
    """What the device says in one frame."""

    time_ns: int
    x_m: float
    y_m: float
    heading_rad: float
    rear_range_m: float | None
    """Free way behind; None = no such sensor."""
    rear_bumper: bool


class Backing:
    """Counts the way back, and says what forbids more of it."""

    def __init__(self, params: Params) -> None:
        self._params = params
        self._now: Reading | None = None
        self._centre = (0.0, 0.0)
        """Of the fence: where the first reading was taken, odometry's axes."""
        self._ahead_m = 0.0
        self.backed_m = 0.0
        """Way driven backwards since the robot last drove forwards."""

    def see(self, reading: Reading) -> None:
        """Take the newest reading."""
        before, self._now = self._now, reading
        if before is None:
            self._centre = (reading.x_m, reading.y_m)
            return
        dx, dy = reading.x_m - before.x_m, reading.y_m - before.y_m
        dt_s = (reading.time_ns - before.time_ns) * 1e-9
        if math.hypot(dx, dy) > max(_JUMP_M, _JUMP_MPS * dt_s):
            self._centre = (self._centre[0] + dx, self._centre[1] + dy)
            return
        self._count(dx * math.cos(reading.heading_rad) + dy * math.sin(reading.heading_rad))

    def hindrance(self) -> str:
        """Why the robot must not go further back; empty = it may."""
        now, params = self._now, self._params
        if now is None:
            return ""
        if now.rear_bumper:
            return REAR_BUMPER
        if now.rear_range_m is not None and not now.rear_range_m > params.rear_stop_m:
            return REAR
        if self.backed_m >= params.max_reverse_m:
            return REVERSE
        return FENCE if self._leaves_fence(now) else ""

    def _count(self, way_m: float) -> None:
        self._ahead_m = max(0.0, self._ahead_m + way_m)
        if way_m < 0.0:
            self.backed_m -= way_m
        elif self._ahead_m >= _FORGET_M:
            self.backed_m = 0.0

    def _leaves_fence(self, now: Reading) -> bool:
        """Whether the robot is outside and the way back leads further out."""
        x, y = now.x_m - self._centre[0], now.y_m - self._centre[1]
        outwards = -(x * math.cos(now.heading_rad) + y * math.sin(now.heading_rad)) > 0.0
        return math.hypot(x, y) > self._params.fence_m and outwards
