"""What nav_msgs/Odometry says of a robot on a floor. Pure."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from components.base.motion import NS, is_sane
from components.base.ros2.codec import ODOMETRY, MalformedError, decoded

_FURTHEST_M = 1e6
_UNIT = 0.01
"""By how much a quaternion's length may differ from 1; a heading that was never set is all zeros."""


class Odometry(NamedTuple):
    """Pose in the robot's own axes, and twist; heading positive left."""

    x_m: float
    y_m: float
    heading_rad: float
    v_mps: float
    omega_radps: float
    stamp_ns: int
    """On the robot's clock; 0 = not said."""


def odometry_of(payload: bytes) -> Odometry:
    """Read a message.

    Raises:
        MalformedError: it is none, or says what no robot on a floor can mean.
    """
    said = decoded(ODOMETRY, payload)
    x_m, y_m = said.pose.pose.position.x, said.pose.pose.position.y
    v_mps, omega_radps = said.twist.twist.linear.x, said.twist.twist.angular.z
    if not (abs(x_m) <= _FURTHEST_M and abs(y_m) <= _FURTHEST_M and is_sane(v_mps, omega_radps)):
        raise MalformedError(f"odometry ({x_m:g}, {y_m:g}) m, {v_mps:g} m/s, {omega_radps:g} rad/s is absurd")
    return Odometry(x_m, y_m, _heading(said.pose.pose.orientation), v_mps, omega_radps, stamp_of(said.header))


def stamp_of(header: Any) -> int:
    """Time of a header in nanoseconds.

    Raises:
        MalformedError: its nanoseconds are more than a second.
    """
    sec, nanosec = int(header.stamp.sec), int(header.stamp.nanosec)
    if not 0 <= nanosec < NS:
        raise MalformedError(f"stamp {sec} s and {nanosec} ns is no time")
    return sec * NS + nanosec


def _heading(q: Any) -> float:
    """Rotation about the vertical."""
    length = math.hypot(q.x, q.y, q.z, q.w)
    if not abs(length - 1.0) <= _UNIT:
        raise MalformedError(f"orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g}) is no rotation")
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
