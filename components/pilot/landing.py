"""The last centimetres after an approach that leads to the pick-up itself: slow, and straightened before the object.

The gripper reaches over the object only once it points there: with the object far off the axis the robot turns on the
spot. At the pick-up a turn is all that is left to do, since beta can not be changed there. The distance is then the
gripper's reach, so that leaning towards beta shares the error between the gripper's place and its heading.
"""

from __future__ import annotations

import math

from components.pilot.progress import Wish
from components.pilot.rules import Rules
from components.pilot.sight import Sight

_NAME = "servo"
_LEAN = 0.3
"""Bearing to end with, as a share of beta."""
_ALIGNED_RAD = math.radians(1.5)
"""The bearing is met within this."""
_ALIGNING_PER_S = 3.0
"""Turn rate on the spot per radian of bearing error."""
_SLOWER_RAD, _TURNING_RAD = math.radians(3.0), math.radians(9.0)
"""So far off its line the robot drives slower, or only turns."""


def has_landed(rules: Rules, sight: Sight) -> bool:
    """Whether the robot stands at the pick-up and points to it."""
    return _is_near_enough(rules, sight) and abs(_askew_rad(sight)) <= _ALIGNED_RAD


def land(rules: Rules, sight: Sight) -> Wish:
    """Drive up, straighten, or take back a step too far."""
    params, task = rules.params, rules.task
    ahead = task.arrival_tilt_rad - sight.tilt_rad
    if _is_near_enough(rules, sight):
        return Wish(0.0, _limited(rules, _ALIGNING_PER_S * _askew_rad(sight)), _NAME)
    if ahead < 0.0:
        return Wish(-params.servo_slowest * task.speed_mps, 0.0, _NAME)
    share = ahead / params.servo_slow_tilt_rad if params.servo_slow_tilt_rad > 0.0 else 1.0
    share = min(max(share, params.servo_slowest), 1.0) * _straight(rules, sight)
    return Wish(share * task.speed_mps, rules.servo.omega_radps(sight.beta_rad, sight.alpha_rad), _NAME)


def _is_near_enough(rules: Rules, sight: Sight) -> bool:
    return abs(rules.task.arrival_tilt_rad - sight.tilt_rad) <= rules.params.servo_tolerance_rad


def _askew_rad(sight: Sight) -> float:
    return sight.alpha_rad - _LEAN * sight.beta_rad


def _straight(rules: Rules, sight: Sight) -> float:
    """1 on the servo's line, where it asks for no turn; 0 far from it."""
    law = rules.servo
    off = abs(sight.alpha_rad + law.k_beta_per_s / law.k_alpha_per_s * sight.beta_rad)
    return min(max((_TURNING_RAD - off) / (_TURNING_RAD - _SLOWER_RAD), 0.0), 1.0)


def _limited(rules: Rules, omega_radps: float) -> float:
    limit = rules.servo.turn_rate_radps
    return min(max(omega_radps, -limit), limit)
