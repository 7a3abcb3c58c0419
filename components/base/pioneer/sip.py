"""The standard server information packet (SIP): motion, bumpers, battery, sonar, once a cycle. Pure.

Pioneer 2 / PeopleBot Operations Manual, "Server information packets"; ARCOS's longer form as ARIA reads it.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import NamedTuple

STOPPED, MOVING = 0x32, 0x33
"""Types."""
_HEAD = struct.Struct("<BHHhhhBHhHBB")
_SONAR = struct.Struct("<BH")
_TAIL = struct.Struct("<BBBBB")
_STALL_LEFT, _STALL_RIGHT, _REAR, _FRONT = 0x0001, 0x0100, 0x003E, 0x3E00
_MOTORS, _STOP_BUTTON, _E_STALL = 0x0001, 0x0020, 0x0040


class Sip(NamedTuple):
    """One packet, in the robot's own units."""

    moving: bool
    x: int
    """Fifteen bits that wrap, in units of the model's `distance_mm`."""
    y: int
    heading: int
    """4096 to a turn, counter-clockwise."""
    left: int
    """Speed of the left wheel, mm/s (times the model's factor)."""
    right: int
    battery_dv: int
    """Tenths of a volt."""
    stall_bumpers: int
    flags: int
    sonar: Mapping[int, int]
    """Number of a sonar -> range, of those that this packet brings; nothing of a packet that announces more."""
    gripper: int | None = None
    """Byte of the gripper (not GRIPPERpac's layout); which of two it is, sources disagree: the second here."""
    digital_in: int | None = None
    digital_out: int | None = None

    @property
    def stalled(self) -> bool:
        """A wheel is blocked."""
        return bool(self.stall_bumpers & (_STALL_LEFT | _STALL_RIGHT))

    @property
    def front_bumper(self) -> bool:
        """A front bumper is pressed."""
        return bool(self.stall_bumpers & _FRONT)

    @property
    def rear_bumper(self) -> bool:
        """A rear bumper is pressed."""
        return bool(self.stall_bumpers & _REAR)

    @property
    def motors_on(self) -> bool:
        """The motors are enabled."""
        return bool(self.flags & _MOTORS)

    @property
    def stop_button(self) -> bool:
        """The stop button is pressed, or the stop that it made still holds."""
        return bool(self.flags & (_STOP_BUTTON | _E_STALL))


def is_sip(payload: bytes) -> bool:
    """Whether a payload's type is one of the two."""
    return payload[:1] in {bytes((STOPPED,)), bytes((MOVING,))}


def sip_of(payload: bytes) -> Sip | None:
    """The packet; None if it is another, or too short to tell of motion.

    Only what it carries is read: some servers announce sonar readings that do not come.
    """
    if not is_sip(payload) or len(payload) < _HEAD.size:
        return None
    kind, x, y, heading, left, right, battery, stall, _control, flags, _compass, count = _HEAD.unpack_from(payload)
    rest = payload[_HEAD.size :]
    readings, tail = rest[: count * _SONAR.size], rest[count * _SONAR.size :]
    is_whole = len(readings) == count * _SONAR.size
    sonar = dict(_SONAR.iter_unpack(readings)) if is_whole else {}
    motion = (kind == MOVING, x, y, heading, left, right, battery, stall, flags, sonar)
    if len(tail) < _TAIL.size:
        return Sip(*motion)
    _first, gripper, _analog, digital_in, digital_out = _TAIL.unpack_from(tail)
    return Sip(*motion, gripper, digital_in, digital_out)
