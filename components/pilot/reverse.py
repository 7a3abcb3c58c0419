"""Driving back after a training trial, the object in view, to a start pose of the robot's own choosing.

Going backwards along a constant bearing, beta' = (v/d) sin(alpha) and d' = -v cos(alpha) give
d(beta) / d(ln d) = -tan(alpha); and d is proportional to cot(tilt). So the bearing that changes beta on the way is
known without any calibration.
"""

from __future__ import annotations

import math

import numpy as np

from components.pilot.progress import Start, Wish
from components.pilot.rules import Rules
from components.pilot.sight import Sight

_LEAST_LOG = 0.25
"""ln(d*/d) is not taken smaller: near the end beta can hardly be moved, and the bearing would jump about."""
_FULL_STOP_RAD = math.radians(60.0)
"""With a bearing error this large the robot only turns."""


def drawn_start(rules: Rules, generator: np.random.Generator, sight: Sight) -> Start:
    """Start pose, uniform over most of the ranges and over the distances that are still ahead (behind the robot)."""
    task, share = rules.task, rules.params.start_share
    beta, alpha, way = generator.uniform((-share, -share, 0.0), (share, share, 1.0))
    near, far = _cot(task.start_tilt_max_rad), _cot(task.start_tilt_min_rad)
    here = min(max(_cot(sight.tilt_rad), near), far) if sight.visible else near
    return Start(
        float(beta) * task.beta_range_rad,
        float(alpha) * task.alpha_range_rad,
        math.atan2(1.0, here + float(way) * (far - here)),
    )


def is_far_enough(sight: Sight, start: Start) -> bool:
    """Whether the object is as high in view as at the start."""
    return sight.tilt_rad <= start.tilt_rad


def back_off(rules: Rules, sight: Sight, start: Start) -> Wish:
    """Drive backwards on the bearing that brings beta to the start's."""
    params = rules.params
    close = sight.tilt_rad > params.reverse_clear_tilt_rad
    error = sight.alpha_rad - (0.0 if close else held_bearing(rules, sight, start))
    share = 1.0 if close else max(0.0, 1.0 - abs(error) / _FULL_STOP_RAD)
    return Wish(-params.reverse_speed_mps * share, _turn(rules, error), "reverse")


def held_bearing(rules: Rules, sight: Sight, start: Start) -> float:
    """Bearing along which the way back ends at the start's beta, within the limit."""
    log = math.log(_cot(start.tilt_rad) / _cot(sight.tilt_rad)) if sight.tilt_rad > start.tilt_rad else 0.0
    bearing = math.atan2(sight.beta_rad - start.beta_rad, max(log, _LEAST_LOG))
    return min(max(bearing, -rules.params.reverse_bearing_rad), rules.params.reverse_bearing_rad)


def turn(rules: Rules, sight: Sight, start: Start) -> Wish:
    """Turn on the spot towards the start's bearing."""
    return Wish(0.0, _turn(rules, sight.alpha_rad - start.alpha_rad), "reverse")


def has_turned(rules: Rules, sight: Sight, start: Start) -> bool:
    """Whether the bearing is the start's."""
    return abs(sight.alpha_rad - start.alpha_rad) <= rules.params.reverse_tolerance_rad


def _turn(rules: Rules, error_rad: float) -> float:
    rate = rules.params.reverse_turn_rate_radps
    return min(max(rules.params.reverse_gain_per_s * error_rad, -rate), rate)


def _cot(angle_rad: float) -> float:
    return 1.0 / math.tan(angle_rad)
