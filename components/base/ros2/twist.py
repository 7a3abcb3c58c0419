"""A command as ROS 2 takes it: forwards along x, left about z. Pure."""

from __future__ import annotations

import math
from typing import NamedTuple

from components.base.ports import Ros2
from components.base.ros2 import codec


class Twist(NamedTuple):
    """Speed and turn rate, positive forwards and to the left."""

    v_mps: float = 0.0
    omega_radps: float = 0.0


STILL = Twist()


def limited(v_mps: float, omega_radps: float, params: Ros2) -> Twist:
    """A wish within the limits; of one that is no number, rest."""
    if not (math.isfinite(v_mps) and math.isfinite(omega_radps)):
        return STILL
    speed_mps, turn_radps = params.max_speed_mps, params.max_turn_rate_radps
    if params.watchdog_s > 0.0:
        speed_mps = min(speed_mps, params.unattended_m / params.watchdog_s)
    return Twist(min(max(v_mps, -speed_mps), speed_mps), min(max(omega_radps, -turn_radps), turn_radps))


def payload(twist: Twist, wall_ns: int, params: Ros2) -> bytes:
    """A Twist or, if the robot wants it, a TwistStamped of this moment, as CDR."""
    linear = codec.message(codec.VECTOR, x=twist.v_mps, y=0.0, z=0.0)
    angular = codec.message(codec.VECTOR, x=0.0, y=0.0, z=twist.omega_radps)
    plain = codec.message(codec.TWIST, linear=linear, angular=angular)
    if not params.stamped:
        return codec.encoded(codec.TWIST, plain)
    stamp = codec.message(codec.TIME, sec=wall_ns // 1_000_000_000, nanosec=wall_ns % 1_000_000_000)
    header = codec.message(codec.HEADER, stamp=stamp, frame_id=params.frame)
    return codec.encoded(codec.TWIST_STAMPED, codec.message(codec.TWIST_STAMPED, header=header, twist=plain))
