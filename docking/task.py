"""The task in perceptual space (slope, pan, tilt): ranges, goal, actions, limits. No metres, no calibration."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from docking.actions import ACTION_SETS, action_set
from docking.angles import DEG
from docking.camera_offset import CameraOffset
from runtime.params import ConfigurationError, between, odd, one_of, positive


class Seen(NamedTuple):
    """The object as seen from the axle, wherever the camera is. Beta and alpha are relative to the goal."""

    beta_rad: float
    alpha_rad: float
    tilt_rad: float
    """That a camera on the axis would have: what stands for the distance."""
    too_close: bool
    """Nearer to the table's edge than `tilt_limit_rad` allows."""


@dataclass(frozen=True)
class Task:
    """What docking means here. Shared by all components of a launch file as its table `[task]`."""

    beta_range_rad: float = between(65 * DEG, 0.01, 1.55)
    """Cells cover +- this about the goal. Martinez-Marin and Duckett 2005, Table I."""
    alpha_range_rad: float = between(80 * DEG, 0.01, 3.14)
    """As above, for the bearing."""
    beta_cells: int = odd(31)
    """Table I, simulation; 15 on their robot."""
    alpha_cells: int = odd(31)
    """Table I, simulation; 15 on their robot."""
    speed_mps: float = positive(0.1)
    """The one translational speed. Section VI."""
    turn_rate_radps: float = positive(10 * DEG)
    """Actions are +- this. Table I, simulation."""
    action_set: str = one_of("one-speed", *ACTION_SETS)
    """`one-speed`: the paper's two turn rates at one speed; `two-speeds`: also at half the speed; `reverse`: also
    backwards at the same speed. The paper's future work."""
    goal_slope: float = between(0.0, -20.0, 20.0)
    """Slope of the table edge in the image when the object can be picked up."""
    goal_pan_rad: float = between(0.0, -math.pi, math.pi)
    """Pan when the object can be picked up."""
    goal_tilt_rad: float = between(57.5 * DEG, 0.0, 1.57)
    """Tilt when the object can be picked up. Ours, as the simulated camera reads it with the gripper at its pose 0.28 m
    ahead: 0.6 deg less than atan(0.45 / 0.28), because the nearer half of a can takes more pixels than the other."""
    goal_heading_rad: float = between(0.0, -1.2, 1.2)
    """Heading against the table's normal when the object can be picked up; 0 = square to the table. One pose can not
    tell an oblique robot from a turned camera, so this is told."""
    tilt_limit_rad: float = between(58.5 * DEG, 0.0, 1.57)
    """Sink: nearer to the edge than a robot that sees the object straight ahead at this tilt, by a camera on its axis.
    Ours: 0.276 m from axle to object: room for the 3.2 cm that it needs to stop from 0.1 m/s, and a centimetre more."""
    start_tilt_min_rad: float = between(12.7 * DEG, 0.0, 1.57)
    """`reverse()` ends at a tilt drawn between this (2 m away) ..."""
    start_tilt_max_rad: float = between(24.2 * DEG, 0.0, 1.57)
    """... and this (1 m away). The paper reverses until the tilt is below 20 deg."""
    beta_reading: str = one_of("tilt-corrected", "tilt-corrected", "arctan")
    """beta = atan(slope / sin(tilt)), exact at the image centre, or the paper's atan(slope), which is biased."""

    @property
    def actions(self) -> tuple[tuple[float, float], ...]:
        """(v_mps, omega_radps) of each action: even ones turn left, odd ones right. Mirroring swaps them."""
        return action_set(self.action_set, self.speed_mps, self.turn_rate_radps)

    def __post_init__(self) -> None:
        """Check what no single field shows."""
        if not self.arrival_tilt_rad < self.tilt_limit_rad:
            raise ConfigurationError(
                f"task.tilt_limit_rad must be larger than the tilt at the goal, {self.arrival_tilt_rad:.4g}, "
                f"or the goal is in the sink; got {self.tilt_limit_rad:g}"
            )

    @cached_property
    def offset(self) -> CameraOffset:
        """Where the camera must be for the goal to be what it is."""
        line_rad = _line(self.goal_slope, self.goal_tilt_rad)
        return CameraOffset.of_pick_up(line_rad, self.goal_pan_rad, self.goal_tilt_rad, self.goal_heading_rad)

    @cached_property
    def arrival_tilt_rad(self) -> float:
        """Tilt at the goal, by a camera on the axis."""
        return self.offset.from_axle(self.goal_pan_rad, self.goal_tilt_rad).tilt_rad

    @cached_property
    def goal_beta_rad(self) -> float:
        """What the goal's slope reads as, seen from the axle."""
        turn_rad = self.offset.from_axle(self.goal_pan_rad, self.goal_tilt_rad).turn_rad
        return self.beta(self.goal_slope, self.goal_tilt_rad) + turn_rad

    def beta(self, slope: float, tilt_rad: float) -> float:
        """Angle between the table's normal and the line camera-object, read from the slope of the edge."""
        return math.atan(slope) if self.beta_reading == "arctan" else _line(slope, tilt_rad)

    def seen(self, slope: float, pan_rad: float, tilt_rad: float) -> Seen:
        """What a percept says about the axle. The goal is (0, 0) at `arrival_tilt_rad`."""
        view = self.offset.from_axle(pan_rad, tilt_rad)
        beta_rad = self.beta(slope, tilt_rad) + view.turn_rad - self.goal_beta_rad
        line_rad = _line(slope, tilt_rad) + view.turn_rad
        return Seen(beta_rad, view.alpha_rad, view.tilt_rad, self._is_too_close(line_rad, view.tilt_rad))

    def _is_too_close(self, line_rad: float, tilt_rad: float) -> bool:
        """Whether the axle is nearer to the table's edge than `tilt_limit_rad` allows, however the robot stands to it.

        Distance to the edge is distance to the object times cos(beta), so tan(tilt) / cos(beta) must not grow too
        large; no length is needed.
        """
        return math.tan(tilt_rad) > math.tan(self.tilt_limit_rad) * math.cos(line_rad)


def _line(slope: float, tilt_rad: float) -> float:
    """Exact at the image centre: slope = tan(line) sin(tilt)."""
    return math.atan2(slope, math.sin(max(tilt_rad, 1e-3)))
