"""Goal and sink as level functions: at most 0 inside, growing outwards. Compiled.

Angles are counted in half goal cells (or the docking tolerance), lengths in two centimetres, so that a level of 1 is
about one goal away in every direction. Points are (beta rad, alpha rad, d m).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

_LENGTH_M = 0.02
FAR = 1.0
"""Levels are cut off here."""


class Limits(NamedTuple):
    """Numbers that say what is goal and what is sink, for compiled code; rad and m."""

    beta_goal_rad: float
    alpha_goal_rad: float
    beta_range_rad: float
    alpha_range_rad: float
    d_min_m: float
    d_max_m: float
    gripper_m: float
    docking: bool
    docked_m: float
    docked_rad: float


@njit(nogil=True, cache=True, error_model="numpy")
def cell_level(limits: Limits, beta: float, alpha: float, d: float) -> float:
    """At most 0 in the goal cell, not closer than the sink."""
    near = (limits.d_min_m - d) / _LENGTH_M
    return max(abs(beta) / limits.beta_goal_rad - 1.0, abs(alpha) / limits.alpha_goal_rad - 1.0, near)


@njit(nogil=True, cache=True, error_model="numpy")
def dock_level(limits: Limits, beta: float, alpha: float, d: float) -> float:
    """At most 0 where the gripper is at the object, within the tolerances."""
    if abs(d - limits.gripper_m) > 2.0 * limits.docked_m:  # the gripper is at least that far away
        return FAR
    heading = beta - alpha
    x = limits.gripper_m * math.cos(heading) - d * math.cos(beta)
    y = limits.gripper_m * math.sin(heading) - d * math.sin(beta)
    return min(FAR, max(math.hypot(x, y) / limits.docked_m, abs(heading) / limits.docked_rad) - 1.0)


@njit(nogil=True, cache=True, error_model="numpy")
def goal_level(limits: Limits, beta: float, alpha: float, d: float) -> float:
    """At most 0 in the goal."""
    return dock_level(limits, beta, alpha, d) if limits.docking else cell_level(limits, beta, alpha, d)


@njit(nogil=True, cache=True, error_model="numpy")
def sink_level(limits: Limits, beta: float, alpha: float, d: float) -> float:
    """Above 0 in the sink: outside the ranges, too close or too far."""
    return max(
        (abs(beta) - limits.beta_range_rad) / limits.beta_goal_rad,
        (abs(alpha) - limits.alpha_range_rad) / limits.alpha_goal_rad,
        (limits.d_min_m - d) / _LENGTH_M,
        (d - limits.d_max_m) / _LENGTH_M,
    )


@njit(nogil=True, cache=True, error_model="numpy")
def judge(limits: Limits, points: NDArray[np.float64]) -> NDArray[np.int8]:
    """[N] of points [N, 3]: 1 in the goal, -1 in the sink or not a number, else 0."""
    verdicts = np.zeros(len(points), np.int8)
    for n in range(len(points)):
        beta, alpha, d = points[n]
        if not math.isfinite(beta + alpha + d):
            verdicts[n] = -1
        elif goal_level(limits, beta, alpha, d) <= 0.0:
            verdicts[n] = 1
        elif sink_level(limits, beta, alpha, d) > 0.0:
            verdicts[n] = -1
    return verdicts
