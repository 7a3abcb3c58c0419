"""What the base may be told: limits of speed, turn rate and their growth."""

from __future__ import annotations

import math
from typing import NamedTuple

from components.base.ports import Params

ABSURD_MPS, ABSURD_RADPS = 5.0, 20.0
"""No commander means this; what asks for it is broken and gets zero."""
_SHORTEST_S, _LONGEST_S = 0.02, 0.125
"""Bounds of the time between two commands that the limit of acceleration reckons with."""
NS = 1_000_000_000
"""Nanoseconds in a second."""


class Motion(NamedTuple):
    """Speed and turn rate, positive forwards and to the left, and what the gripper shall do."""

    v_mps: float = 0.0
    omega_radps: float = 0.0
    gripper: int = 0


STILL = Motion()


def is_sane(v_mps: float, omega_radps: float) -> bool:
    """Whether a command can be meant: finite and of a robot's size."""
    return abs(v_mps) <= ABSURD_MPS and abs(omega_radps) <= ABSURD_RADPS


def limited(wish: Motion, before: Motion, since_s: float, params: Params) -> Motion:
    """The wish within the limits, `since_s` after the command `before`."""
    dt = min(max(since_s, _SHORTEST_S), _LONGEST_S)
    v = _clamped(wish.v_mps, params.max_speed_mps)
    omega = _clamped(wish.omega_radps, params.max_turn_rate_radps)
    return Motion(
        _slewed(v, before.v_mps, params.max_acceleration_mps2 * dt),
        _slewed(omega, before.omega_radps, params.max_turn_acceleration_radps2 * dt),
        wish.gripper,
    )


def _slewed(wish: float, before: float, step: float) -> float:
    """Growth by at most a step; towards zero at once."""
    from_size = abs(before) if wish * before > 0.0 else 0.0
    return math.copysign(min(abs(wish), from_size + step), wish)


def _clamped(value: float, limit: float) -> float:
    return min(max(value, -limit), limit)
