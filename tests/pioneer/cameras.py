"""Pan-tilt cameras seen from their serial port, written from their manuals: a VC-C4 and an EVI-D30.

Both turn the head of a simulated world. Pure: bytes and times in, bytes out.
"""

import math
from collections import deque

from components.simulator.head import Target

NS = 1_000_000_000


class Mounted:
    """What both have in common: the world's head, a mount, and answers that take their time."""

    def __init__(self, head, inverted=False, answer_s=0.03):
        self.head = head
        self.sign = 1 if inverted else -1
        self.answer_ns = round(answer_s * NS)
        self.busy_until_ns = 0
        self.zoom = 0
        self.deaf = False
        self.heard = []
        self._answers = deque()
        self._buffer = b""

    def look(self, pan_deg, tilt_deg, time_ns):
        pan, tilt = (math.radians(self.sign * angle) for angle in (pan_deg, tilt_deg))
        self.head().follow(Target(pan, tilt, 0.0, 0.0, time_ns))

    @property
    def angles_deg(self):
        return [math.degrees(self.sign * angle) for angle in self.head().angles_rad]

    def hear(self, data, time_ns):
        self._buffer += data
        while not self.deaf and self.end in self._buffer:
            whole, _, self._buffer = self._buffer.partition(self.end)
            self.heard.append(whole)
            for reply in self.obey(whole, time_ns):
                self._answers.append((time_ns + self.answer_ns, reply))

    def speak(self, time_ns):
        said = b""
        while self._answers and self._answers[0][0] <= time_ns:
            said += self._answers.popleft()[1]
        return said


class Canon(Mounted):
    """VC-C4: deaf before host mode and power, busy for a while after power, 30 deg either way until it is told more."""

    end = b"\xef"
    power_s = 0.5

    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)
        self.host = self.power = False
        self.tilts = (-267, 267)

    def obey(self, whole, time_ns):
        if whole[:4] != b"\xff\x30\x30\x00":
            return ()
        command, rest = whole[4:5], whole[5:]
        if command == b"\x90":
            self.host = rest == b"\x30"
            return (_answer(),)
        if time_ns < self.busy_until_ns:
            return (_answer(error=0x31),)
        if not self.host or not (self.power or command == b"\xa0"):
            return (_answer(error=0x39),)
        try:
            return (self._do(command, rest, time_ns),)
        except ValueError:  # digits that are none, or too few
            return (_answer(error=0x35),)

    def _do(self, command, rest, time_ns):
        match command:
            case b"\xa0":
                self._switch(rest == b"\x31", time_ns)
            case b"\x64":
                self.tilts = tuple(int(rest[at : at + 4], 16) - 0x8000 for at in (1, 5))
            case b"\x62":
                return self._turn(*(int(rest[at : at + 4], 16) - 0x8000 for at in (0, 4)), time_ns)
            case b"\x53":
                self.look(*self.angles_deg, time_ns)
            case b"\x63":
                steps = (round(angle / 0.1125) + 0x8000 for angle in self.angles_deg)
                return _answer(b"%04X%04X" % tuple(steps))
            case b"\xb3":
                self.zoom = int(rest, 16)
            case b"\xb4":
                return _answer(b"%04X" % self.zoom)
        return _answer()

    def _switch(self, on, time_ns):
        if on and not self.power:
            self.busy_until_ns = time_ns + round(self.power_s * NS)
        self.power = on

    def _turn(self, pan, tilt, time_ns):
        if abs(pan) > 875 or not self.tilts[0] <= tilt <= self.tilts[1]:
            return _answer(error=0x35)
        self.look(pan * 0.1125, tilt * 0.1125, time_ns)
        return _answer()


def _answer(content=b"", error=0x30):
    return b"\xfe\x30\x30" + bytes((error, 0x30)) + content + b"\xef"


class Sony(Mounted):
    """EVI-D30: acknowledges, completes later, has two sockets."""

    end = b"\xff"

    def obey(self, whole, time_ns):
        if whole[:1] == b"\x88":
            return (b"\x88\x30\x02\xff" if whole[1:2] == b"\x30" else b"\x88\x01\x00\x01\xff",)
        if time_ns < self.busy_until_ns:
            return (b"\x90\x60\x03\xff",)
        if whole[:3] == b"\x81\x01\x06":
            return self._drive(whole, time_ns)
        return self._zoom_or_say(whole)

    def _zoom_or_say(self, whole):
        if whole[:4] == b"\x81\x01\x04\x47" and len(whole) == 8:
            self.zoom = _signed(whole[4:8])
            return _DONE
        pan, tilt = self.angles_deg
        said = {
            b"\x81\x09\x04\x47": _nibbles(self.zoom),
            b"\x81\x09\x06\x12": _nibbles(round(pan * 8.8)) + _nibbles(round(tilt * 12)),
        }.get(whole)
        return (b"\x90\x60\x02\xff",) if said is None else (b"\x90\x50" + said + b"\xff",)

    def _drive(self, whole, time_ns):
        """Absolute, relative, home and reset; a drive by joystick is acknowledged only."""
        kind, pan, tilt = whole[3], 0.0, 0.0
        if kind in {2, 3} and len(whole) == 14:
            here = (self.angles_deg[0] * 8.8, self.angles_deg[1] * 12) if kind == 3 else (0, 0)
            pan, tilt = (_signed(whole[at : at + 4]) + before for at, before in zip((6, 10), here, strict=True))
        elif kind not in {4, 5}:
            return _DONE if kind == 1 else (b"\x90\x60\x02\xff",)
        if abs(pan) > 880 or abs(tilt) > 300:
            return (b"\x90\x61\x41\xff",)
        self.look(pan / 8.8, tilt / 12, time_ns)
        return _DONE


_DONE = (b"\x90\x41\xff", b"\x90\x51\xff")


def _signed(nibbles):
    value = int("".join(f"{nibble:x}" for nibble in nibbles), 16)
    return value - 0x10000 if value > 0x7FFF else value


def _nibbles(value):
    return bytes(int(digit, 16) for digit in f"{value & 0xFFFF:04x}")
