"""The task in perceptual space (slope, pan, tilt): ranges, goal, actions, limits. No metres, no calibration."""

from __future__ import annotations

import math
from dataclasses import dataclass

from docking.angles import DEG
from runtime.params import between, odd, one_of, positive


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
    goal_slope: float = between(0.0, -20.0, 20.0)
    """Slope of the table edge in the image when the object can be picked up."""
    goal_pan_rad: float = between(0.0, -math.pi, math.pi)
    """Pan when the object can be picked up."""
    goal_tilt_rad: float = between(57.5 * DEG, 0.0, 1.57)
    """Tilt when the object can be picked up. Ours, as the simulated camera reads it with the gripper at its pose 0.28 m
    ahead: 0.6 deg less than atan(0.45 / 0.28), because the nearer half of a can takes more pixels than the other."""
    tilt_limit_rad: float = between(58.5 * DEG, 0.0, 1.57)
    """Sink: nearer to the edge than a robot that sees the object straight ahead at this tilt. Ours: 0.276 m from axle
    to object: room for the 3.2 cm that it needs to stop from 0.1 m/s, and a centimetre more."""
    start_tilt_min_rad: float = between(12.7 * DEG, 0.0, 1.57)
    """`reverse()` ends at a tilt drawn between this (2 m away) ..."""
    start_tilt_max_rad: float = between(24.2 * DEG, 0.0, 1.57)
    """... and this (1 m away). The paper reverses until the tilt is below 20 deg."""
    beta_reading: str = one_of("tilt-corrected", "tilt-corrected", "arctan")
    """beta = atan(slope / sin(tilt)), exact at the image centre, or the paper's atan(slope), which is biased."""

    @property
    def actions(self) -> tuple[tuple[float, float], ...]:
        """(v_mps, omega_radps) of each action: 0 turns left, 1 turns right. Mirroring swaps them."""
        return ((self.speed_mps, self.turn_rate_radps), (self.speed_mps, -self.turn_rate_radps))

    @property
    def goal_beta_rad(self) -> float:
        """Angle that the goal's slope reads as."""
        return self.beta(self.goal_slope, self.goal_tilt_rad)

    def beta(self, slope: float, tilt_rad: float) -> float:
        """Angle between the table's normal and the line robot-object, read from the slope of the edge."""
        if self.beta_reading == "arctan":
            return math.atan(slope)
        return math.atan2(slope, math.sin(max(tilt_rad, 1e-3)))

    def is_too_close(self, slope: float, tilt_rad: float) -> bool:
        """Whether the robot is nearer to the table's edge than `tilt_limit_rad` allows, however it stands to it.

        Distance to the edge is distance to the object times cos(beta), so tan(tilt) / cos(beta) must not grow too
        large; no length is needed.
        """
        beta_rad = math.atan2(slope, math.sin(max(tilt_rad, 1e-3)))
        return math.tan(tilt_rad) > math.tan(self.tilt_limit_rad) * math.cos(beta_rad)

    def state(self, slope: float, pan_rad: float, tilt_rad: float) -> tuple[float, float]:
        """(beta, alpha) relative to the goal, which is (0, 0)."""
        return self.beta(slope, tilt_rad) - self.goal_beta_rad, pan_rad - self.goal_pan_rad
