"""The plant: a unicycle that sees an object. Everything that moves a robot in this repository calls `advance`.

World frame: origin at the object, x along the table's inward normal (the docking direction), y along the table's
edge to the left, heading counter-clockwise from x. Omega is positive to the left.
The functions are plain Python that numba can compile: `numba.njit(plant.advance)`.
"""

from __future__ import annotations

import math


def advance(
    x_m: float, y_m: float, heading_rad: float, v_mps: float, omega_radps: float, dt_s: float
) -> tuple[float, float, float]:
    """Pose after `dt_s` at constant speed and turn rate: an exact arc, not an Euler step.

    Uses the chord of the arc, v dt sinc(omega dt / 2), which has no division by a small omega.
    """
    half = 0.5 * omega_radps * dt_s
    sinc = math.sin(half) / half if abs(half) > 1e-9 else 1.0
    chord = v_mps * dt_s * sinc
    return (
        x_m + chord * math.cos(heading_rad + half),
        y_m + chord * math.sin(heading_rad + half),
        heading_rad + 2.0 * half,
    )


def observe(x_m: float, y_m: float, heading_rad: float) -> tuple[float, float, float]:
    """(beta, alpha, d_axle_m) of the object at the origin, seen from a pose.

    beta is the direction of the line robot-object against the table's normal, alpha its bearing from the heading
    (positive to the left), d the distance from the axle. Hence beta' = (v/d) sin(alpha) and
    alpha' = (v/d) sin(alpha) - omega.
    """
    beta = math.atan2(-y_m, -x_m)
    alpha = math.pi - (math.pi - (beta - heading_rad)) % (2.0 * math.pi)
    return beta, alpha, math.hypot(x_m, y_m)


def pose(beta_rad: float, alpha_rad: float, d_axle_m: float) -> tuple[float, float, float]:
    """(x_m, y_m, heading_rad) from which the object is seen at (beta, alpha, d): the inverse of `observe`."""
    return -d_axle_m * math.cos(beta_rad), -d_axle_m * math.sin(beta_rad), beta_rad - alpha_rad


def printed_rates(alpha_rad: float, d_m: float, v_mps: float, omega_radps: float) -> tuple[float, float, float]:
    """(beta', alpha', d') as printed in Martinez-Marin and Duckett 2005, eq. 1-3, read with the minus sign.

    No real robot moves like this: its own forward motion centres the object. It exists for the paper's table only.
    """
    line_of_sight = -v_mps / d_m * math.sin(alpha_rad)
    return line_of_sight, line_of_sight - omega_radps, -v_mps * math.cos(alpha_rad)
