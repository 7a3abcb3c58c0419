"""Decodes the three ROS 2 messages that a session can be made from.

By our own words for their fields, not by the bag's: a bag may describe them in either of ROS's languages, or falsely.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

from mcap.records import Schema

from runtime.params import ConfigurationError

COMPRESSED, RAW, ODOMETRY = "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image", "nav_msgs/msg/Odometry"
_HEADER = """
================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
_FIELDS = {
    COMPRESSED: "std_msgs/Header header\nstring format\nuint8[] data\n" + _HEADER,
    RAW: "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
    "uint8[] data\n" + _HEADER,
    ODOMETRY: "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
    "geometry_msgs/TwistWithCovariance twist\n"
    + _HEADER
    + """================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================
MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
================
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
""",
}
"""As `ros2 interface show` has them, without comments and constants."""


class UndecodableError(Exception):
    """These bytes are no such message; the text says how."""


def plain_name(schema: str) -> str:
    """`sensor_msgs/Image` and `sensor_msgs::msg::Image` are `sensor_msgs/msg/Image`."""
    parts = [part for part in schema.replace("::", "/").split("/") if part]
    return "/".join([parts[0], "msg", parts[-1]]) if len(parts) in {2, 3} else schema


def decoder_of(name: str) -> Callable[[bytes], Any]:
    """What decodes the CDR bytes of one of the three; raises UndecodableError.

    Raises:
        ConfigurationError: the library for it is not installed.
    """
    try:
        from mcap_ros2.decoder import DecoderFactory  # noqa: PLC0415  (an extra)
    except ModuleNotFoundError:
        raise ConfigurationError("berth import needs mcap-ros2-support: pip install 'berth[ros]'") from None
    words = Schema(id=1, name=name, encoding="ros2msg", data=_FIELDS[name].encode())
    decode = DecoderFactory().decoder_for("cdr", words)

    def decoded(payload: bytes) -> Any:
        if decode is None or len(payload) < 4 or payload[0] != 0 or payload[1] > 1:
            raise UndecodableError("not plain CDR")
        try:
            return decode(payload)
        except (struct.error, ValueError, IndexError, OverflowError):
            raise UndecodableError("damaged CDR") from None

    return decoded
