"""CONFIGpac: what the robot is and how it is set up in FLASH, as far as a driver needs it. Pure.

Order of the fields as ARIA's ArRobotConfigPacketReader reads them.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

TYPE = 0x20
_TOPS = struct.Struct("<B5H")
_SETUP = struct.Struct("<BBBHHBHHH")
_MORE = struct.Struct("<BHHHHHH")
UNSET = 9999
"""Simulators say this for a top speed that they do not have."""


class ConfigPac(NamedTuple):
    """In the robot's units: mm/s, deg/s, ms."""

    kind: str
    subclass: str
    serial: str
    turn_top: int
    speed_top: int
    name: str
    cycle_ms: int
    has_gripper: bool
    watchdog_ms: int
    """0 = none."""
    turn_max: int | None = None
    """Set in FLASH; None = not said."""
    speed_max: int | None = None

    @property
    def fastest_mmps(self) -> int | None:
        """What the robot's own limits are; None = not said."""
        return min((v for v in (self.speed_top, self.speed_max) if v and v < UNSET), default=None)

    @property
    def fastest_turn_degps(self) -> int | None:
        """As above."""
        return min((v for v in (self.turn_top, self.turn_max) if v and v < UNSET), default=None)


def config_of(payload: bytes) -> ConfigPac | None:
    """The packet; None if it is another or shorter than its watchdog."""
    if payload[:1] != bytes((TYPE,)):
        return None
    try:
        (kind, subclass, serial), at = _texts(payload, 1, 3)
        _, turn_top, speed_top, *_ = _TOPS.unpack_from(payload, at)
        (name,), at = _texts(payload, at + _TOPS.size, 1)
        cycle, _, _, gripper, _, _, _, _, watchdog = _SETUP.unpack_from(payload, at)
    except (struct.error, ValueError):
        return None
    at += _SETUP.size
    more = _MORE.unpack_from(payload, at) if len(payload) >= at + _MORE.size else (None,) * 7
    return ConfigPac(
        kind, subclass, serial, turn_top, speed_top, name, cycle, bool(gripper), watchdog, more[5], more[6]
    )


def _texts(payload: bytes, at: int, count: int) -> tuple[list[str], int]:
    """Texts that each end with a zero, and where they end.

    Raises:
        ValueError: there are fewer.
    """
    found = []
    for _ in range(count):
        end = payload.index(0, at)
        found.append(payload[at:end].decode("ascii", "replace"))
        at = end + 1
    return found, at


def names_of(payload: bytes) -> tuple[str, str, str]:
    """(name, class, subclass) of the robot, from its echo of SYNC2; what is missing is empty."""
    parts = [part.decode("ascii", "replace") for part in payload[1:].split(b"\0")]
    name, kind, subclass = [*parts, "", "", ""][:3]
    return name, kind, subclass
