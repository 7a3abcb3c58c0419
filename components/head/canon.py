"""Canon VC-C4 and VC-C50i: FF 30 30 00, command, parameters, EF; angles are steps of 0.1125 deg. Pure.

Canon VC-C50i programmer's manual; ARIA's ArVCC4.
"""

from __future__ import annotations

import math

from components.head.angles import per_degree
from components.head.reply import Kind, Reply, Request

_BEGIN, _END = b"\xff\x30\x30\x00", 0xEF
_ANSWER = b"\xfe\x30\x30"
_SHORT, _LONG = 6, 14
"""Bytes of an answer: without, and with a position."""
_ZERO = 0x8000
_STEP_DEG = 0.1125
PAN = per_degree(1 / _STEP_DEG, -870, 870)
TILT = per_degree(1 / _STEP_DEG, -267, 782)
"""Upwards; the range that `setup` asks for: -30 to 88 deg."""
_FASTEST = (800, 662)
_SLOWEST = 8
"""Steps a second."""
_ERRORS = {0x30: Kind.DONE, 0x31: Kind.BUSY, 0x35: Kind.REFUSED, 0x39: Kind.UNREADY}


class Canon:
    """Requests of a VC-C4, and its answers."""

    pan, tilt = PAN, TILT

    def __init__(self) -> None:
        self._buffer = b""

    def setup(self, pan_rate_radps: float, tilt_rate_radps: float) -> tuple[Request, ...]:
        """Listen to us, be on, tilt over the whole range, at this speed."""
        slews = zip((0x50, 0x51), (pan_rate_radps, tilt_rate_radps), _FASTEST, strict=True)
        return (
            _request(b"\x90\x30"),
            _request(b"\xa0\x31"),
            _request(b"\x64\x31" + _angle(TILT.low) + _angle(TILT.high)),
            *(_request(bytes((code,)) + b"%03X" % _slew(rate, most)) for code, rate, most in slews),
        )

    def move(self, pan: int, tilt: int) -> Request:
        """Look there."""
        return _request(b"\x62" + _angle(pan) + _angle(tilt))

    def inquire(self) -> Request:
        """Say where you look."""
        return Request(_request(b"\x63").content, _LONG)

    def forget(self) -> None:
        """What has come so far belongs to nothing."""
        self._buffer = b""

    def feed(self, data: bytes) -> list[Reply]:
        """The answers that are complete; any bytes whatever are good input."""
        self._buffer += data
        found = []
        while (at := self._buffer.find(_ANSWER[:1])) >= 0:
            end = self._buffer.find(bytes((_END,)), at)
            if end < 0:
                break
            reply = _reply(self._buffer[at : end + 1])
            if reply is None:
                self._buffer = self._buffer[at + 1 :]
                continue
            found.append(reply)
            self._buffer = self._buffer[end + 1 :]
        self._buffer = self._buffer[at : at + 2 * _LONG] if at >= 0 else b""
        return found


def _request(command: bytes) -> Request:
    return Request(_BEGIN + command + bytes((_END,)), _SHORT)


def _angle(steps: int) -> bytes:
    return b"%04X" % (steps + _ZERO)


def _slew(rate_radps: float, most: int) -> int:
    return min(max(round(math.degrees(rate_radps) / _STEP_DEG), _SLOWEST), most)


def _reply(whole: bytes) -> Reply | None:
    """An answer from its first to its last byte; None if it is none."""
    if not whole.startswith(_ANSWER) or len(whole) not in {_SHORT, _LONG}:
        return None
    kind = _ERRORS.get(whole[3], Kind.REFUSED)
    if len(whole) == _SHORT or kind != Kind.DONE:
        return Reply(kind)
    try:
        return Reply(Kind.POSITION, int(whole[5:9], 16) - _ZERO, int(whole[9:13], 16) - _ZERO)
    except ValueError:
        return None
