"""What a pan-tilt unit may be told."""

from __future__ import annotations

import math
from typing import NamedTuple

from components.head.ports import Params

UNREADABLE_RAD = 2.0 * math.pi
"""An encoder that reads beyond this is broken."""


class Motion(NamedTuple):
    """Angles at a capture time, and the rates from there on."""

    pan_rad: float
    tilt_rad: float
    pan_rate_radps: float = 0.0
    tilt_rate_radps: float = 0.0


def limited(wish: Motion, held: Motion, params: Params) -> Motion:
    """The wish within the unit's limits; a wish with a NaN or an infinity holds the position `held`."""
    if not all(map(math.isfinite, wish)):
        return limited(Motion(held.pan_rad, held.tilt_rad), Motion(0.0, 0.0), params)
    pan = _clamped(wish.pan_rad, -params.pan_limit_rad, params.pan_limit_rad)
    tilt = _clamped(wish.tilt_rad, params.tilt_low_rad, params.tilt_high_rad)
    return Motion(
        pan,
        tilt,
        _clamped(wish.pan_rate_radps, -params.pan_rate_radps, params.pan_rate_radps),
        _clamped(wish.tilt_rate_radps, -params.tilt_rate_radps, params.tilt_rate_radps),
    )


def wired(motion: Motion, params: Params) -> Motion:
    """The motion as the device wants it."""
    pan, tilt = params.pan_scale, params.tilt_scale
    return Motion(
        pan * motion.pan_rad, tilt * motion.tilt_rad, pan * motion.pan_rate_radps, tilt * motion.tilt_rate_radps
    )


def readable(pan_rad: float, tilt_rad: float) -> bool:
    """Whether these are angles that encoders can read."""
    return abs(pan_rad) <= UNREADABLE_RAD and abs(tilt_rad) <= UNREADABLE_RAD


def _clamped(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)
