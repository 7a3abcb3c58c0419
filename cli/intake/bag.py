"""A ROS 2 bag in MCAP: which of its topics to take, and what is on them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from mcap.records import Channel, Schema

from cli.intake.folder import natural
from cli.intake.found import Found, Picture, Pose, Useless
from cli.intake.picture import Raw
from cli.intake.ros2 import COMPRESSED, ODOMETRY, RAW, UndecodableError, decoder_of, plain_name
from runtime.mcap_items import Fault
from runtime.params import ConfigurationError
from runtime.recording import Logged, Recording

_IMAGES = frozenset({COMPRESSED, RAW})


def files_of(bag: Path) -> list[Path]:
    """The MCAP files of a bag: itself, or those in its folder."""
    return sorted(bag.glob("*.mcap"), key=natural) if bag.is_dir() else [bag]


def topics_of(files: Sequence[Path]) -> dict[str, str]:
    """Topic -> one of the three message types; the others are left out.

    Raises:
        ConfigurationError: a file can not be read or is not MCAP.
    """
    found: dict[str, str] = {}
    for file in files:
        schemas: dict[int, str] = {}
        for item in Recording(file).items([], lambda _: False):
            if isinstance(item, Schema):
                schemas[item.id] = plain_name(item.name)
            elif isinstance(item, Channel) and item.message_encoding == "cdr":
                name = schemas.get(item.schema_id, "")
                if name in _IMAGES or name == ODOMETRY:
                    found.setdefault(item.topic, name)
    return found


def chosen(topics: dict[str, str], image: str, odometry: str, bag: Path) -> dict[str, str]:
    """The image topic and, if there is one, the odometry.

    Raises:
        ConfigurationError: there is no such topic, or more than one and none was named.
    """
    images = [topic for topic, name in topics.items() if name in _IMAGES]
    poses = [topic for topic, name in topics.items() if name == ODOMETRY]
    if not images:
        raise ConfigurationError(
            f"{bag}: must hold sensor_msgs/CompressedImage or sensor_msgs/Image in CDR; it holds none"
        )
    names = [_one(images, image, "--image", bag)]
    if poses:
        names.append(_one(poses, odometry, "--odometry", bag))
    elif odometry:
        raise ConfigurationError(f"--odometry must be a topic of {bag}; it has no nav_msgs/Odometry")
    return {topic: topics[topic] for topic in names}


def _one(topics: list[str], wanted: str, option: str, bag: Path) -> str:
    if wanted in topics:
        return wanted
    listed = ", ".join(topics[:10])
    if wanted:
        raise ConfigurationError(f"{option} must be one of {bag}: {listed}; got {wanted!r}")
    if len(topics) > 1:
        raise ConfigurationError(f"{option} must be given: {bag} has {listed}")
    return topics[0]


def read(files: Sequence[Path], topics: dict[str, str], faults: list[Fault]) -> Iterator[Found]:
    """What is on these topics, in the order of the files."""
    decoders = {name: decoder_of(name) for name in (*_IMAGES, ODOMETRY)}
    for file in files:
        for logged in Recording(file).messages(list(topics), faults):
            name = plain_name(logged.schema)
            if name not in decoders or (name in _IMAGES) != (topics[logged.topic] in _IMAGES):
                yield Useless("another type on the same topic")
                continue
            try:
                message = decoders[name](logged.payload)
            except UndecodableError as error:
                yield Useless(str(error))
                continue
            yield _found(message, name, logged)


def _found(message: Any, name: str, logged: Logged) -> Found:
    stamp = message.header.stamp
    stamp_ns = stamp.sec * 1_000_000_000 + stamp.nanosec if stamp.sec > 0 else logged.time_ns
    if name == COMPRESSED:
        return Picture(stamp_ns, bytes(message.data))
    if name == RAW:
        raw = Raw(message.width, message.height, message.encoding, message.step, bytes(message.data))
        return Picture(stamp_ns, raw)
    return _pose(message, stamp_ns)


def _pose(message: Any, stamp_ns: int) -> Found:
    place, turn, twist = message.pose.pose.position, message.pose.pose.orientation, message.twist.twist
    heading = math.atan2(2.0 * (turn.w * turn.z + turn.x * turn.y), 1.0 - 2.0 * (turn.y**2 + turn.z**2))
    numbers = (place.x, place.y, heading, twist.linear.x, twist.angular.z)
    if not all(math.isfinite(number) for number in numbers):
        return Useless("odometry that is not finite")
    return Pose(stamp_ns, *numbers)
