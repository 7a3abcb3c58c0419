"""Where to look for an object that is out of sight."""

from __future__ import annotations

import math
from dataclasses import dataclass

from components.tracker.ports import Params

LONGEST_S = 0.5
"""Frames further apart than this move the search no further."""
FIRST_ROW = 3
"""Legs before the rows of the sweep."""


@dataclass
class Search:
    """First stay; then a look to the side where the object was heading and to the other; then home; then the sweep.

    The sweep's rows go to and fro over the whole pan, the first at home_tilt_rad, the next ones below; it begins again
    after the last row.
    """

    frames: int = 0
    """Without the object."""
    pan_rad: float = 0.0
    """Where the head looks, and the rates at which it moves on."""
    tilt_rad: float = 0.0
    pan_rate_radps: float = 0.0
    tilt_rate_radps: float = 0.0
    from_pan_rad: float = 0.0
    """Where the object was lost."""
    from_tilt_rad: float = 0.0
    side: float = 1.0
    """+1 = it was heading to the left, -1 = to the right."""
    leg: int = 0
    time_ns: int = 0

    def watch(self, pan_rad: float, tilt_rad: float, side: float) -> None:
        """The object is in sight, the head looks there."""
        self.frames = self.leg = 0
        self.pan_rad = self.from_pan_rad = pan_rad
        self.tilt_rad = self.from_tilt_rad = tilt_rad
        self.pan_rate_radps = self.tilt_rate_radps = 0.0
        self.side = math.copysign(1.0, side)

    def aim(self, time_ns: int, params: Params) -> tuple[float, float, float, float]:
        """One frame without the object: (pan_rad, tilt_rad, pan_rate_radps, tilt_rate_radps)."""
        dt_s = (time_ns - self.time_ns) * 1e-9
        self.time_ns = time_ns
        self.frames += 1
        if self.frames > params.patience_frames:
            self._move(min(max(dt_s, 0.0), LONGEST_S), params)
        return self.pan_rad, self.tilt_rad, self.pan_rate_radps, self.tilt_rate_radps

    def _move(self, dt_s: float, params: Params) -> None:
        goal_pan, goal_tilt = self._waypoint(params)
        if self.pan_rate_radps or self.tilt_rate_radps:
            self.pan_rad = _towards(self.pan_rad, goal_pan, abs(self.pan_rate_radps) * dt_s)
            self.tilt_rad = _towards(self.tilt_rad, goal_tilt, abs(self.tilt_rate_radps) * dt_s)
        if math.hypot(goal_pan - self.pan_rad, goal_tilt - self.tilt_rad) < 1e-6:
            self.leg = self.leg + 1 if self.leg + 1 < FIRST_ROW + 2 * _rows(params) else FIRST_ROW
            goal_pan, goal_tilt = self._waypoint(params)
        fastest = params.search_rate_radps
        self.pan_rate_radps = min(max((goal_pan - self.pan_rad) / params.frame_s, -fastest), fastest)
        self.tilt_rate_radps = min(max((goal_tilt - self.tilt_rad) / params.frame_s, -fastest), fastest)

    def _waypoint(self, params: Params) -> tuple[float, float]:
        """Where the present leg ends."""
        if self.leg < 2:
            near = self.side * params.search_near_rad * (1.0 if self.leg == 0 else -1.0)
            return _towards(0.0, self.from_pan_rad + near, params.search_pan_rad), self.from_tilt_rad
        if self.leg == 2:
            return 0.0, params.home_tilt_rad
        row, half = divmod(self.leg - FIRST_ROW, 2)
        side = self.side if (row + half) % 2 == 0 else -self.side
        return side * params.search_pan_rad, params.home_tilt_rad + row * params.search_row_rad


def _rows(params: Params) -> int:
    return 1 + max(0, math.floor((params.search_tilt_high_rad - params.home_tilt_rad) / params.search_row_rad))


def _towards(value: float, goal: float, most: float) -> float:
    """The goal, or as near to it as `most` allows."""
    return value + min(max(goal - value, -most), most)
