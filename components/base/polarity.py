"""How this robot is wired: between the robot's own axes (forwards, left, SI) and its device's."""

from __future__ import annotations

import math

from components.base.motion import Motion
from components.base.ports import Params


def wired(motion: Motion, params: Params) -> tuple[float, float]:
    """(speed, turn rate) as the device wants them."""
    return params.speed_scale * motion.v_mps, params.turn_scale * motion.omega_radps


def odometry_read(reading: tuple[float, ...], params: Params) -> tuple[float, float, float, float, float]:
    """(x_m, y_m, heading_rad, v_mps, omega_radps) of the device in the robot's axes.

    A heading that counts the wrong way round mirrors y.
    """
    x, y, heading, v, omega = reading
    way, turn = params.odometry_scale, params.heading_scale
    return way * x, way * math.copysign(1.0, turn) * y, turn * heading, way * v, turn * omega


def beams_read(inner: bool, outer: bool, params: Params) -> tuple[bool, bool]:
    """(inner, outer) broken, from what the device calls so."""
    inner, outer = inner != params.inner_beam_inverted, outer != params.outer_beam_inverted
    return (outer, inner) if params.beams_swapped else (inner, outer)
