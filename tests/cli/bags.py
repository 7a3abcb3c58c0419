"""ROS 2 bags for the tests, written by the rosbags library, which Berth itself does not use."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from mcap.writer import CompressionType, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_HUMBLE)
_TYPES = STORE.types
COMPRESSED, RAW, ODOMETRY = "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image", "nav_msgs/msg/Odometry"
EPOCH_S = 1_700_000_000


def header(stamp_s: float, frame="camera"):
    seconds = int(stamp_s)
    time = _TYPES["builtin_interfaces/msg/Time"](sec=seconds, nanosec=round((stamp_s - seconds) * 1e9))
    return _TYPES["std_msgs/msg/Header"](stamp=time, frame_id=frame)


def compressed(stamp_s: float, data: bytes, form="jpeg") -> tuple[str, bytes]:
    message = _TYPES[COMPRESSED](header=header(stamp_s), format=form, data=np.frombuffer(data, np.uint8))
    return COMPRESSED, serialized(message, COMPRESSED)


def raw(stamp_s: float, pixels, encoding: str, **changes) -> tuple[str, bytes]:
    """An image `[height, width(, bytes)]`; `changes` falsify its fields."""
    rows = np.ascontiguousarray(pixels).reshape(len(pixels), -1)
    fields = {"height": rows.shape[0], "width": pixels.shape[1], "encoding": encoding, "is_bigendian": 0,
              "step": rows.shape[1], "data": rows.ravel(), **changes}  # fmt: skip
    return RAW, serialized(_TYPES[RAW](header=header(stamp_s), **fields), RAW)


def odometry(stamp_s: float, x_m: float, y_m: float, heading_rad: float, v_mps=0.0, omega_radps=0.0):
    vector, point = _TYPES["geometry_msgs/msg/Vector3"], _TYPES["geometry_msgs/msg/Point"]
    turn = _TYPES["geometry_msgs/msg/Quaternion"](0.0, 0.0, np.sin(heading_rad / 2), np.cos(heading_rad / 2))
    pose = _TYPES["geometry_msgs/msg/Pose"](point(x_m, y_m, 0.0), turn)
    twist = _TYPES["geometry_msgs/msg/Twist"](vector(v_mps, 0.0, 0.0), vector(0.0, 0.0, omega_radps))
    nothing = np.zeros(36)
    message = _TYPES[ODOMETRY](
        header=header(stamp_s, "odom"),
        child_frame_id="base",
        pose=_TYPES["geometry_msgs/msg/PoseWithCovariance"](pose, nothing),
        twist=_TYPES["geometry_msgs/msg/TwistWithCovariance"](twist, nothing),
    )
    return ODOMETRY, serialized(message, ODOMETRY)


def serialized(message, name: str) -> bytes:
    return bytes(STORE.serialize_cdr(message, name))


def write(
    file: Path, messages: Iterable[tuple[str, tuple[str, bytes]]], *, words="ros2msg", compression="zstd"
) -> Path:
    """A bag of (topic, (type, CDR bytes)) in this order, 0.1 s apart; `words` is the schemas' language."""
    with file.open("wb") as stream:
        writer = Writer(stream, compression=CompressionType[compression.upper()])
        writer.start(profile="ros2", library="rosbag2")
        channels: dict[tuple[str, str], int] = {}
        for number, (topic, (name, payload)) in enumerate(messages):
            if (topic, name) not in channels:
                text = STORE.generate_msgdef(name)[0] if words == "ros2msg" else "module nonsense { }"
                schema = writer.register_schema(name, words, text.encode())
                channels[topic, name] = writer.register_channel(topic, "cdr", schema)
            log_ns = EPOCH_S * 1_000_000_000 + number * 100_000_000
            writer.add_message(channels[topic, name], log_ns, payload, log_ns)
        writer.finish()
    return file
