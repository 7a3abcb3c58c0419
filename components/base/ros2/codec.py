"""ROS 2 messages as CDR, and the hashes of their types, without a ROS installation. Pure."""

from __future__ import annotations

from functools import cache
from typing import Any

from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

TIME, HEADER = "builtin_interfaces/msg/Time", "std_msgs/msg/Header"
VECTOR, TWIST, TWIST_STAMPED = "geometry_msgs/msg/Vector3", "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
ODOMETRY, BATTERY = "nav_msgs/msg/Odometry", "sensor_msgs/msg/BatteryState"
BOOL, KOBUKI = "std_msgs/msg/Bool", "kobuki_ros_interfaces/msg/BumperEvent"
HAZARDS = "irobot_create_msgs/msg/HazardDetectionVector"
_OTHERS = {
    "irobot_create_msgs/msg/HazardDetection": "std_msgs/Header header\nuint8 type",
    HAZARDS: "std_msgs/Header header\nirobot_create_msgs/HazardDetection[] detections",
    KOBUKI: "uint8 bumper\nuint8 state",
}
"""Definitions that are not part of a ROS distribution: iRobotEducation/irobot_create_msgs, kobuki-base."""
_LARGEST_BYTES = 65536
"""No message that is read here has more; a hostile length must not ask for memory."""


class MalformedError(ValueError):
    """A message is no message of its type, or says what no robot means."""


def message(name: str, **fields: Any) -> Any:
    """A message of a type, from its fields."""
    return _types().types[name](**fields)


def encoded(name: str, value: Any) -> bytes:
    """A message as little-endian CDR, with the four bytes of its encapsulation."""
    return bytes(_types().serialize_cdr(value, name, little_endian=True))


def decoded(name: str, payload: bytes) -> Any:
    """Inverse of `encoded`; takes both byte orders.

    Raises:
        MalformedError: these bytes are no such message.
    """
    if len(payload) > _LARGEST_BYTES:
        raise MalformedError(f"{len(payload)} bytes are no {name}")
    try:
        return _types().deserialize_cdr(payload, name)
    except SerdeError as error:
        raise MalformedError(str(error)) from None


def type_hash(name: str) -> str:
    """REP 2016: `RIHS01_` and 64 hexadecimal digits."""
    return _types().hash_rihs01(name)


@cache
def _types() -> Typestore:
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, definition in _OTHERS.items():
        store.register(get_types_from_msg(definition, name))
    return store
