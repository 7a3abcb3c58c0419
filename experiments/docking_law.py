"""The smooth docking law of Park and Kuipers 2011, as Nav2's graceful controller states it. Needs a metric pose.

Park and Kuipers, "A Smooth Control Law for Graceful Motion of Differential Wheeled Mobile Robots in 2D Environment",
ICRA 2011, eq. 13-15; nav2_graceful_controller, smooth_control_law.cpp.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from experiments.problem import Floats

_FLAT = 1e-9
"""A smaller curvature (1/m) is a straight line."""


@dataclass(frozen=True)
class DockingLaw:
    """Gains and limits. The defaults are those of Nav2's docking server (opennav_docking), at our robot's limits."""

    k_phi: float = 3.0
    """Rate at which the heading error decays against the distance error."""
    k_delta: float = 2.0
    """Rate of the heading loop."""
    speed_beta: float = 0.4
    """How much curvature slows down."""
    speed_lambda: float = 2.0
    """How sharply it does."""
    slowdown_radius_m: float = 0.25
    """Nearer than this the speed falls in proportion to the distance."""
    speed_max_mps: float = 0.1
    speed_min_mps: float = 0.0
    turn_rate_max_radps: float = np.pi / 18.0
    constant_speed: bool = False
    """Always drive at `speed_max_mps` and cut the turn rate off, as the paper's robot would."""

    def curvature(self, r_m: Floats, phi_rad: Floats, delta_rad: Floats) -> Floats:
        """Curvature (1/m) of the path at egocentric polar coordinates `[N]` of the target.

        Args:
            r_m: distance of the target.
            phi_rad: heading of the target, against the line of sight.
            delta_rad: own heading, against the line of sight.
        """
        slow = delta_rad - np.arctan(-self.k_phi * phi_rad)
        fast = (1.0 + self.k_phi / (1.0 + (self.k_phi * phi_rad) ** 2)) * np.sin(delta_rad)
        curvature: Floats = -(self.k_delta * slow + fast) / np.maximum(r_m, _FLAT)
        return curvature

    def command(self, r_m: Floats, curvature_per_m: Floats) -> tuple[Floats, Floats]:
        """Speed (m/s) and turn rate (rad/s) `[N]` that follow a curvature within the limits."""
        if self.constant_speed:
            v = np.full_like(curvature_per_m, self.speed_max_mps)
            return v, np.clip(v * curvature_per_m, -self.turn_rate_max_radps, self.turn_rate_max_radps)
        v = self.speed_max_mps / (1.0 + self.speed_beta * np.abs(curvature_per_m) ** self.speed_lambda)
        v = np.minimum(v, self.speed_max_mps * r_m / self.slowdown_radius_m)
        v = np.clip(v, self.speed_min_mps, self.speed_max_mps)
        omega = np.clip(v * curvature_per_m, -self.turn_rate_max_radps, self.turn_rate_max_radps)
        straight = np.abs(curvature_per_m) < _FLAT
        return np.where(straight, v, omega / np.where(straight, 1.0, curvature_per_m)), omega

    def toward(self, target: tuple[float, float, float], pose: tuple[Floats, Floats, Floats]) -> tuple[Floats, Floats]:
        """Speed and turn rate `[N]` from poses (x m, y m, heading rad), `[N]` each, towards a target pose."""
        r, phi, delta = polar(target, pose)
        return self.command(r, self.curvature(r, phi, delta))


def polar(target: tuple[float, float, float], pose: tuple[Floats, Floats, Floats]) -> tuple[Floats, Floats, Floats]:
    """Egocentric polar coordinates (r m, phi rad, delta rad), `[N]` each, of a target pose from robot poses."""
    dx, dy = target[0] - pose[0], target[1] - pose[1]
    line_of_sight = np.arctan2(-dy, dx)
    return np.hypot(dx, dy), _wrapped(target[2] + line_of_sight), _wrapped(pose[2] + line_of_sight)


def _wrapped(angle_rad: Floats) -> Floats:
    wrapped: Floats = np.pi - (np.pi - angle_rad) % (2.0 * np.pi)
    return wrapped
