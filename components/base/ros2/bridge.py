"""The two ways in which ROS 2 meets zenoh today. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from components.base.ports import Ros2
from components.base.ros2.rmw_zenoh import RmwZenoh
from components.base.ros2.ros2dds import Ros2Dds
from components.base.ros2.topic import Topic


class Bridge(Protocol):
    """How a topic is said over zenoh."""

    def key(self, topic: Topic) -> str: ...  # noqa: D102
    def attachment(self, sequence: int, wall_ns: int) -> bytes | None: ...  # noqa: D102
    def tokens(self, published: Sequence[Topic], subscribed: Sequence[Topic]) -> tuple[str, ...]: ...  # noqa: D102


def bridge_of(params: Ros2, zid: str) -> Bridge:
    """The one that the parameters name, for the zenoh session with this id."""
    if params.bridge == "ros2dds":
        return Ros2Dds()
    return RmwZenoh(params.domain, params.distro, params.namespace, params.node, zid)
