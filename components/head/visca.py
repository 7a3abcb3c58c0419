"""Sony EVI-D30 and D31: VISCA. Pure. Sony's EVI-D30/D31 command list and the EVI-D100 manual (D30 mode)."""

from __future__ import annotations

import math

from components.head.angles import per_degree
from components.head.reply import Kind, Reply, Request

_END = 0xFF
_SHORT, _LONG = 3, 11
"""Bytes of an answer: acknowledgement, and a position."""
_LONGEST = 16
PAN = per_degree(8.8, -880, 880)
"""To the right; +-100 deg."""
TILT = per_degree(12.0, -300, 300)
"""Upwards; +-25 deg."""
_PAN_STEP_DEGPS, _PAN_FASTEST = 3.3, 0x18
_TILT_STEP_DEGPS, _TILT_FASTEST = 2.5, 0x14
_BUFFER_FULL, _NOT_EXECUTABLE = 0x03, 0x41
_FROM_CAMERA, _TO_ALL = 0x90, 0x88


class Visca:
    """Requests of an EVI-D30, and its answers."""

    pan, tilt = PAN, TILT

    def __init__(self) -> None:
        self._buffer = b""
        self._speeds = bytes((_PAN_FASTEST, _TILT_FASTEST))

    def setup(self, pan_rate_radps: float, tilt_rate_radps: float) -> tuple[Request, ...]:
        """Take an address, forget all that was asked."""
        pan = _speed(pan_rate_radps, _PAN_STEP_DEGPS, _PAN_FASTEST)
        tilt = _speed(tilt_rate_radps, _TILT_STEP_DEGPS, _TILT_FASTEST)
        self._speeds = bytes((pan, tilt))
        return Request(b"\x88\x30\x01\xff", 4), Request(b"\x88\x01\x00\x01\xff", 5)

    def move(self, pan: int, tilt: int) -> Request:
        """Look there."""
        return Request(b"\x81\x01\x06\x02" + self._speeds + _nibbles(pan) + _nibbles(tilt) + b"\xff", _SHORT)

    def inquire(self) -> Request:
        """Say where you look."""
        return Request(b"\x81\x09\x06\x12\xff", _LONG)

    def forget(self) -> None:
        """What has come so far belongs to nothing."""
        self._buffer = b""

    def feed(self, data: bytes) -> list[Reply]:
        """The answers that are complete; any bytes whatever are good input."""
        *wholes, rest = (self._buffer + data).split(bytes((_END,)))
        self._buffer = rest[-_LONGEST:]
        return [reply for whole in wholes if (reply := _reply(whole)) is not None]


def _nibbles(steps: int) -> bytes:
    return bytes((steps & 0xFFFF) >> shift & 15 for shift in (12, 8, 4, 0))


def _speed(rate_radps: float, step_degps: float, fastest: int) -> int:
    return min(max(round(math.degrees(rate_radps) / step_degps), 1), fastest)


def _reply(whole: bytes) -> Reply | None:
    """An answer without its last byte; None if it is none."""
    if whole[:1] == bytes((_TO_ALL,)):
        return Reply(Kind.DONE)
    if len(whole) < 2 or whole[0] != _FROM_CAMERA:
        return None
    kind = whole[1] & 0xF0
    if kind == 0x40:
        return Reply(Kind.DONE)
    if kind == 0x50:
        return _position(whole[2:]) if len(whole) == _LONG - 1 else Reply(Kind.NEWS)
    if kind == 0x60 and len(whole) > 2:
        again = whole[2] in {_BUFFER_FULL, _NOT_EXECUTABLE}
        return Reply(Kind.BUSY if again else Kind.REFUSED)
    return None


def _position(nibbles: bytes) -> Reply | None:
    if any(nibble > 15 for nibble in nibbles):
        return None
    values = [int.from_bytes(_joined(nibbles[at : at + 4]), "big", signed=True) for at in (0, 4)]
    return Reply(Kind.POSITION, values[0], values[1])


def _joined(nibbles: bytes) -> bytes:
    return bytes((nibbles[0] << 4 | nibbles[1], nibbles[2] << 4 | nibbles[3]))
