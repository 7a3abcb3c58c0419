"""The pan-tilt unit: two axes with lag, slew limits and end stops that follow a moving target."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from components.simulator.params import Params


class Target(NamedTuple):
    """Where the head shall look: angles at a time, and the rates from there on."""

    pan_rad: float
    tilt_rad: float
    pan_rate_radps: float
    tilt_rate_radps: float
    time_ns: int

    @property
    def finite(self) -> bool:
        """All four numbers can be followed."""
        return all(map(math.isfinite, self[:4]))


@dataclass(slots=True)
class Axis:
    """One motor."""

    low_rad: float
    high_rad: float
    limit_radps: float
    angle_rad: float
    rate_radps: float = 0.0

    def step(self, target_rad: float, share: float, dt_s: float) -> None:
        """Go `share` of the way to the target, no faster than the slew limit, no further than the end stops."""
        target_rad = min(max(target_rad, self.low_rad), self.high_rad)
        reach = self.limit_radps * dt_s
        way = min(max(share * (target_rad - self.angle_rad), -reach), reach)
        self.angle_rad += way
        self.rate_radps = way / dt_s


class Head:
    """Both axes and the newest target."""

    def __init__(self, params: Params) -> None:
        self._lag_s = params.head_lag_s
        self._hold_s = params.head_hold_s
        self.pan = Axis(-params.pan_limit_rad, params.pan_limit_rad, params.pan_rate_radps, 0.0)
        self.tilt = Axis(0.0, params.tilt_limit_rad, params.tilt_rate_radps, params.home_tilt_rad)
        self._target: Target | None = None

    @property
    def angles_rad(self) -> tuple[float, float]:
        """(pan, tilt)."""
        return self.pan.angle_rad, self.tilt.angle_rad

    def follow(self, target: Target) -> None:
        """From now on follow this target; one that is not finite is ignored."""
        if target.finite:
            self._target = target

    def look(self, pan_rad: float, tilt_rad: float) -> None:
        """Be there at once, at rest, without a target: for placing the robot."""
        self._target = None
        for axis, angle_rad in ((self.pan, pan_rad), (self.tilt, tilt_rad)):
            axis.angle_rad = min(max(angle_rad, axis.low_rad), axis.high_rad)
            axis.rate_radps = 0.0

    def step(self, time_ns: int, dt_s: float) -> None:
        """Move for `dt_s` up to `time_ns`. The share of a first-order lag is exact for a resting target."""
        if self._target is None:
            self.pan.rate_radps = self.tilt.rate_radps = 0.0
            return
        target = self._target
        age_s = min(max((time_ns - target.time_ns) * 1e-9, 0.0), self._hold_s)
        share = 1.0 - math.exp(-dt_s / self._lag_s) if self._lag_s > 0.0 else 1.0
        self.pan.step(target.pan_rad + target.pan_rate_radps * age_s, share, dt_s)
        self.tilt.step(target.tilt_rad + target.tilt_rate_radps * age_s, share, dt_s)
