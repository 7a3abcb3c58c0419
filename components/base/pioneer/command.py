"""What a client tells the robot: a number, and an integer or a text. Pure.

Pioneer 2 / PeopleBot Operations Manual, "Client commands"; ARIA's ArCommands.h for the newer ones.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from components.base.pioneer.frame import framed

_POSITIVE, _NEGATIVE, _TEXT = 0x3B, 0x1B, 0x2B
"""Types of an argument: an integer, the magnitude of a negative one, a text with its length before it."""
_LARGEST = 0xFFFF
LONGEST_TEXT = 195
"""Bytes; a payload has two bytes more, and its length."""


class Command(IntEnum):
    """Numbers of the commands that anything here sends or understands."""

    PULSE = 0
    OPEN = 1
    CLOSE = 2
    ENABLE = 4
    SETA = 5
    SETV = 6
    SETO = 7
    MOVE = 8
    ROTATE = 9
    SETRV = 10
    VEL = 11
    HEAD = 12
    DHEAD = 13
    CONFIG = 18
    ENCODER = 19
    RVEL = 21
    SETRA = 23
    SONAR = 28
    STOP = 29
    VEL2 = 32
    GRIPPER = 33
    GRIPPERVAL = 36
    GRIPREQUEST = 37
    TTY2 = 42
    GETAUX = 43
    BUMPSTALL = 44
    E_STOP = 55
    TTY3 = 66
    GETAUX2 = 67


SYNC0, SYNC1, SYNC2 = (framed(bytes((step,))) for step in range(3))
"""The handshake; the robot echoes each. On an open robot they are PULSE, OPEN and CLOSE."""


def plain(command: int) -> bytes:
    """Packet of a command without an argument."""
    return framed(bytes((command,)))


def integer(command: int, value: int) -> bytes:
    """Packet of a command with an integer, low byte first; of a negative one the magnitude is sent.

    Raises:
        ValueError: it does not fit into two bytes.
    """
    if abs(value) > _LARGEST:
        raise ValueError(f"argument must be at most {_LARGEST} either way; got {value}")
    kind = _POSITIVE if value >= 0 else _NEGATIVE
    return framed(bytes((command, kind)) + abs(value).to_bytes(2, "little"))


def text(command: int, content: bytes) -> bytes:
    """Packet of a command with bytes.

    Raises:
        ValueError: too many of them.
    """
    if len(content) > LONGEST_TEXT:
        raise ValueError(f"text must have at most {LONGEST_TEXT} bytes; got {len(content)}")
    return framed(bytes((command, _TEXT, len(content))) + content)


def wheels(left: int, right: int) -> bytes:
    """VEL2: speeds of both wheels in units of the robot (20 mm/s), -128 to 127. The left one is the high byte.

    Raises:
        ValueError: out of range.
    """
    both = left.to_bytes(1, "little", signed=True) + right.to_bytes(1, "little", signed=True)
    return integer(Command.VEL2, int.from_bytes(both, "big", signed=True))


class Spoken(NamedTuple):
    """A command as the robot hears it."""

    command: int
    value: int | None = None
    content: bytes | None = None


def heard(payload: bytes) -> Spoken | None:
    """What a client's payload says; None = nothing that the protocol knows.

    An integer with a positive type is taken as it is: some clients send negative ones as raw bytes.
    """
    if len(payload) == 1:
        return Spoken(payload[0])
    if len(payload) < 3:
        return None
    command, kind, rest = payload[0], payload[1], payload[2:]
    if kind == _TEXT:
        return Spoken(command, content=rest[1 : 1 + rest[0]]) if len(rest) > rest[0] else None
    if kind not in {_POSITIVE, _NEGATIVE} or len(rest) < 2:
        return None
    size = int.from_bytes(rest[:2], "little")
    return Spoken(command, size if kind == _POSITIVE else -size)
