"""The robot's counters as a way that never wraps and never jumps. Pure."""

from __future__ import annotations

import math

from components.base.pioneer.model import TURN_UNIT_RAD, Model
from components.base.pioneer.sip import Sip

_BITS = 0x7FFF
_TURNOVER = 0x8000
_FURTHEST = 0x1000
"""Counts between two packets; more is a wrap or a counter that was set to another value."""
FASTEST_MPS = 3.0
"""No Pioneer moves so; such a step is a counter that was set to another value."""
_SLACK_M = 0.05


class Odometry:
    """Adds up the steps between packets; goes on from where it was when the robot begins anew."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._before: tuple[int, int, float] | None = None
        self._before_ns = 0
        self._turned_rad = 0.0
        """Our axes against the robot's."""
        self.x_m = self.y_m = self.heading_rad = 0.0
        self.jumps = 0
        """Steps left out because no robot makes them."""

    def forget(self, model: Model | None = None) -> None:
        """The robot may begin anew: its next packet is where we are."""
        self._before = None
        self._model = model or self._model

    def add(self, sip: Sip, time_ns: int) -> None:
        """Take a packet."""
        x, y, heading = sip.x & _BITS, sip.y & _BITS, sip.heading * TURN_UNIT_RAD
        before, self._before = self._before, (x, y, heading)
        dt_s, self._before_ns = (time_ns - self._before_ns) * 1e-9, time_ns
        if before is not None:
            dx, dy = self._step_m(x - before[0]), self._step_m(y - before[1])
            if math.hypot(dx, dy) <= FASTEST_MPS * dt_s + _SLACK_M:
                self._move(dx, dy, math.remainder(heading - before[2], 2.0 * math.pi))
                return
            self.jumps += 1
        self._turned_rad = self.heading_rad - heading

    def _move(self, dx_m: float, dy_m: float, turn_rad: float) -> None:
        cos, sin = math.cos(self._turned_rad), math.sin(self._turned_rad)
        self.x_m += cos * dx_m - sin * dy_m
        self.y_m += sin * dx_m + cos * dy_m
        self.heading_rad += turn_rad

    def _step_m(self, counts: int) -> float:
        if counts > _FURTHEST:
            counts -= _TURNOVER
        elif counts < -_FURTHEST:
            counts += _TURNOVER
        return counts * self._model.distance_mm * 1e-3
