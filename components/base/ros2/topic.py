"""A topic: where a message of which type is published. Pure."""

from __future__ import annotations

from typing import NamedTuple


class Topic(NamedTuple):
    """By its absolute name, as `ros2 topic list` shows it."""

    name: str
    """E.g. `/robot1/cmd_vel`."""
    type: str
    """E.g. `geometry_msgs/msg/Twist`."""

    @property
    def dds_type(self) -> str:
        """The type's name in DDS, e.g. `geometry_msgs::msg::dds_::Twist_`."""
        package, kind, name = self.type.split("/")
        return f"{package}::{kind}::dds_::{name}_"


def absolute(namespace: str, name: str) -> str:
    """A topic's name within a namespace; one that begins with a slash stays."""
    if name.startswith("/"):
        return name
    return "/" + "/".join(part for part in (namespace.strip("/"), name) if part)
