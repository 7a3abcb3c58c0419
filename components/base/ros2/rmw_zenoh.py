"""Topics as rmw_zenoh has them: keys with domain, type and hash, attachments, and tokens for the graph. Pure.

Source: ros2/rmw_zenoh, docs/design.md, liveliness_utils.cpp, attachment_helpers.cpp, qos.cpp.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence

import xxhash

from components.base.ros2.codec import type_hash
from components.base.ros2.topic import Topic

NO_HASH = "TypeHashNotSupported"
"""Humble's: it knows no type hashes."""
_ATTACHMENT = struct.Struct("<qqB16s")
_QOS = "::,10:,:,:,,"
"""Reliable, volatile, keep last 10: what differs from rmw_zenoh's defaults is said, the rest is empty."""
_NODE, _PUBLISHER, _SUBSCRIPTION = "NN", "MP", "MS"


class RmwZenoh:
    """One node with its publishers and subscriptions, in one zenoh session."""

    def __init__(self, domain: int, distro: str, namespace: str, node: str, zid: str) -> None:
        """Nobody hears of it yet.

        Args:
            domain: `ROS_DOMAIN_ID`.
            distro: name of the robot's ROS 2 distribution.
            namespace: of the node, `robot1` or empty.
            node: its name.
            zid: id of the zenoh session, hexadecimal.
        """
        self._domain = domain
        self._hashed = distro != "humble"
        self._begin = f"@ros2_lv/{domain}/{zid}/0"
        self._node = f"%/{_mangled('/' + namespace.strip('/'))}/{node}"
        self._gid = b""

    def key(self, topic: Topic) -> str:
        """Domain, name, type, hash of the type."""
        return f"{self._domain}/{topic.name.strip('/')}/{topic.dds_type}/{self._hash(topic)}"

    def attachment(self, sequence: int, wall_ns: int) -> bytes | None:
        """Of a message: its number from 1, when it was made, and the publisher's id. Without it rmw_zenoh drops it."""
        return _ATTACHMENT.pack(sequence, wall_ns, len(self._gid), self._gid)

    def tokens(self, published: Sequence[Topic], subscribed: Sequence[Topic]) -> tuple[str, ...]:
        """Keys of the liveliness tokens, by which ROS's tools see us."""
        found = tuple(self._tokens(published, subscribed))
        self._gid = gid(found[1])
        return found

    def _tokens(self, published: Sequence[Topic], subscribed: Sequence[Topic]) -> Iterator[str]:
        yield f"{self._begin}/0/{_NODE}/{self._node}"
        entities = [(_PUBLISHER, topic) for topic in published] + [(_SUBSCRIPTION, topic) for topic in subscribed]
        for number, (kind, topic) in enumerate(entities, 1):
            what = f"{_mangled(topic.name)}/{topic.dds_type}/{self._hash(topic)}/{_QOS}"
            yield f"{self._begin}/{number}/{kind}/{self._node}/{what}"

    def _hash(self, topic: Topic) -> str:
        return type_hash(topic.type) if self._hashed else NO_HASH


def gid(token: str) -> bytes:
    """Global id of the entity with this token: XXH3-128, the lower half first `[16]`."""
    return xxhash.xxh3_128_intdigest(token.encode()).to_bytes(16, "little")


def _mangled(name: str) -> str:
    return name.replace("/", "%")
