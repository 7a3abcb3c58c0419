"""Topics as zenoh-bridge-ros2dds (or its plugin) has them: the name is the key, the payload is DDS's own. Pure."""

from __future__ import annotations

from collections.abc import Sequence

from components.base.ros2.topic import Topic


class Ros2Dds:
    """The bridge finds our subscribers and publishers by themselves: it needs no token and no attachment."""

    def key(self, topic: Topic) -> str:
        """Without the leading slash."""
        return topic.name.lstrip("/")

    def attachment(self, sequence: int, wall_ns: int) -> bytes | None:
        """None."""
        del sequence, wall_ns
        return None

    def tokens(self, published: Sequence[Topic], subscribed: Sequence[Topic]) -> tuple[str, ...]:
        """None."""
        del published, subscribed
        return ()
