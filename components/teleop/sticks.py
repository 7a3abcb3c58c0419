"""The Linux joystick: events of eight bytes to readings. Pure; any bytes whatever are good input.

struct js_event of linux/joystick.h: u32 time in ms, s16 value, u8 type, u8 number; type 1 = button, 2 = axis, and 0x80
is set for the state at opening.
"""

from __future__ import annotations

import struct

from components.teleop.core import Hand, Request
from components.teleop.ports import Gamepad

_EVENT = struct.Struct("<IhBB")
_BUTTON, _AXIS, _INITIAL = 0x01, 0x02, 0x80
_FULL = 32767.0


class Sticks:
    """The pad as far as its events tell. A dead-man button that was down already must be pressed anew."""

    def __init__(self, params: Gamepad) -> None:
        self._params = params
        self._part = b""
        self._axes: dict[int, float] = {}
        self._dead_man = False
        self._requests = {
            params.take_button: Request.TAKE,
            params.give_button: Request.GIVE,
            params.faster_button: Request.FASTER,
            params.slower_button: Request.SLOWER,
        }

    def feed(self, data: bytes) -> list[Hand]:
        """One reading for each event that is complete."""
        data = self._part + data
        whole = len(data) - len(data) % _EVENT.size
        self._part = data[whole:]
        return [self._take(*event) for event in _EVENT.iter_unpack(data[:whole])]

    def let_go(self) -> None:
        """The pad is not to be trusted: its dead-man button must be pressed anew."""
        self._dead_man = False

    def now(self, request: Request = Request.NOTHING) -> Hand:
        """The pad as it is."""
        return Hand(
            self._dead_man, self._share(self._params.forward_axis), self._share(self._params.left_axis), request
        )

    def _take(self, _time_ms: int, value: int, kind: int, number: int) -> Hand:
        request = Request.NOTHING
        if kind & ~_INITIAL == _AXIS:
            self._axes[number] = max(value / _FULL, -1.0)
        elif kind == _BUTTON and number == self._params.dead_man_button:
            self._dead_man = value == 1
        elif kind == _BUTTON and value == 1:
            request = self._requests.get(number, Request.NOTHING)
        return self.now(request)

    def _share(self, axis: int) -> float:
        """The kernel counts forwards and left as negative."""
        value = self._axes.get(axis, 0.0)
        return -value if abs(value) > self._params.dead_zone else 0.0
