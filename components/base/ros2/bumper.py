"""Bumpers of ROS 2 bases: Create 3 (TurtleBot 4), Kobuki (TurtleBot 2), or a plain contact. Pure."""

from __future__ import annotations

from typing import Any, NamedTuple

from components.base.ros2.codec import BOOL, HAZARDS, KOBUKI, MalformedError, decoded

_BACKUP_LIMIT, _BUMP, _CLIFF, _STALL, _WHEEL_DROP = range(5)
"""HazardDetection.msg of irobot_create_msgs; 5 = an object is near, which a can on a table is."""
_PRESSED = (0, 1)
"""BumperEvent.msg of kobuki_ros_interfaces: released, pressed."""


class Contact(NamedTuple):
    """What forbids a way."""

    front: bool = False
    rear: bool = False
    fault: str = ""
    """Why nothing may move."""


class Bumper:
    """Folds messages of one type."""

    def __init__(self, kind: str) -> None:
        """Nothing is touched.

        Args:
            kind: type of the messages.
        """
        self._kind = kind
        self._held: frozenset[int] = frozenset()
        self.contact = Contact()

    def take(self, payload: bytes) -> None:
        """Take a message.

        Raises:
            MalformedError: it is none of this type; nothing has changed.
        """
        self.contact = {HAZARDS: self._hazards, KOBUKI: self._event, BOOL: _plain}[self._kind](
            decoded(self._kind, payload)
        )

    def _hazards(self, said: Any) -> Contact:
        kinds = {int(each.type) for each in said.detections}
        fault = "a wheel hangs in the air" if _WHEEL_DROP in kinds else ""
        return Contact(bool(kinds & {_BUMP, _CLIFF, _STALL}), _BACKUP_LIMIT in kinds, fault)

    def _event(self, said: Any) -> Contact:
        if said.state not in _PRESSED:
            raise MalformedError(f"bumper state {said.state} is unknown")
        which = {int(said.bumper)}
        self._held = self._held | which if said.state else self._held - which
        return Contact(front=bool(self._held))


def _plain(said: Any) -> Contact:
    return Contact(front=bool(said.data))
