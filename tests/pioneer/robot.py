"""A Pioneer seen from its serial port, written from the manual: it hears packets, moves a body, and speaks.

Pure: bytes and times in, bytes out. It does what the real one does, the awkward included: motors off after connecting,
counters of fifteen bits, a watchdog that resumes the old set-point with the next packet, no acknowledgements.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field

NS = 1_000_000_000
CYCLE_NS = NS // 10


def packet(payload):
    """The manual's own words, a second time."""
    total = 0
    for at in range(0, len(payload) - 1, 2):
        total = (total + payload[at] * 256 + payload[at + 1]) & 0xFFFF
    if len(payload) % 2:
        total ^= payload[-1]
    return bytes((0xFA, 0xFB, len(payload) + 2)) + payload + bytes((total >> 8, total & 255))


@dataclass
class Robot:
    """One robot. `body` has wheels, gripper and odometry; `cameras` what is plugged into its auxiliary ports."""

    body: object
    cameras: dict = field(default_factory=dict)
    """Number of the port -> camera."""
    subclass: str = "peoplebot-sh"
    distance_mm: float = 1.0
    watchdog_ms: int = 2000
    obeys_watchdog: bool = True
    motors_at_open: bool = False
    """As a simulator has it that we did not write."""
    empty_sonar: bool = False
    """As above: 24 sonar readings are announced and none is sent."""
    stop_button: bool = False
    strict: bool = False
    """As above: a packet other than the next SYNC spoils the handshake for good."""
    knows_gripper_pac: bool = True
    """Older firmware tells of its gripper in the standard packet alone."""
    tells_gripper: bool = True
    """In the standard packet, too."""
    gripper_kind: int = 2
    """In GRIPPERpac; 0 = there is none."""
    deaf: bool = False
    """Hears nothing and says nothing: the cable is pulled, or it hangs."""

    def __post_init__(self):
        self.received = []
        """(time, command, value) of everything that was understood."""
        self.reset()

    def reset(self):
        """As after its reset button: waits for SYNC0, at rest, counters at zero."""
        self.step, self.open, self.motors = 0, False, False
        self._stop(None)
        self.heard_ns = self.cycle_ns = None
        self.zero = self.body.odometry.triple
        self.gripper_stream = self.sonar = self.encoder_stream = False
        self.top_mmps, self.top_degps = 750, 100
        self.aux = {}
        self.asked = {}
        self.buffer = b""
        self.out = b""

    def hear(self, data, time_ns):
        """Bytes of the client."""
        if self.deaf:
            return
        self.buffer = (self.buffer + data)[-1024:]
        while (at := self.buffer.find(b"\xfa\xfb")) >= 0 and len(self.buffer) > at + 2:
            end = at + 3 + self.buffer[at + 2]
            if end > len(self.buffer):
                if self.buffer[at + 2] <= 200:
                    break
                self.buffer = self.buffer[at + 1 :]
                continue
            whole, payload = self.buffer[at:end], self.buffer[at + 3 : end - 2]
            if payload and packet(payload) == whole:
                self.buffer = self.buffer[end:]
                self._obey(payload, time_ns)
            else:
                self.buffer = self.buffer[at + 1 :]

    def speak(self, time_ns):
        """Bytes for the client, up to now."""
        for port, camera in self.cameras.items():
            self.aux[port] = self.aux.get(port, b"") + camera.speak(time_ns)
            wanted = self.asked.get(port, 0)
            if wanted and len(self.aux[port]) >= wanted:
                self._say(bytes(({1: 0xB0, 2: 0xB8}[port],)) + self.aux[port][:wanted])
                self.aux[port], self.asked[port] = self.aux[port][wanted:], 0
        if self.open and (self.cycle_ns is None or time_ns - self.cycle_ns >= CYCLE_NS):
            self.cycle_ns = time_ns
            self._say(self._sip(time_ns))
            if self.gripper_stream:
                self._say_gripper()
            if self.encoder_stream:
                self._say_encoders()
        said, self.out = self.out, b""
        return b"" if self.deaf else said

    def twist(self, time_ns):
        """(m/s, rad/s) that the wheels are told now."""
        alive = not self.obeys_watchdog or (
            self.heard_ns is not None and time_ns - self.heard_ns <= self.watchdog_ms * 1_000_000
        )
        if not (self.open and self.motors and alive) or self.stop_button:
            return 0.0, 0.0
        if self.wheels is not None:
            left, right = self.wheels
            return 0.5 * (left + right), 0.5 * (right - left) * 6.0
        return self._speed_mps(), self._turn_radps()

    def _speed_mps(self):
        """That of VEL, or towards the way that MOVE has named."""
        if self.way_m is None:
            return min(max(self.speed_mmps, -self.top_mmps), self.top_mmps) * 1e-3
        return min(max(self.way_m - self._way_m(), -0.3), 0.3)

    def _turn_radps(self):
        """That of RVEL, or towards the heading that HEAD or DHEAD has named."""
        if self.heading_rad is None:
            return math.radians(min(max(self.turn_degps, -self.top_degps), self.top_degps))
        missing = math.remainder(self.heading_rad - self._odometry()[2], 2 * math.pi)
        return min(max(2 * missing, -0.5), 0.5)

    def _way_m(self):
        x, y, heading = self._odometry()
        return x * math.cos(heading) + y * math.sin(heading)

    def _say(self, payload):
        self.out += packet(payload)

    def _obey(self, payload, time_ns):
        command, value = payload[0], None
        if len(payload) >= 4 and payload[1] in {0x3B, 0x1B}:
            value = (payload[2] + 256 * payload[3]) * (1 if payload[1] == 0x3B else -1)
        self.received.append((time_ns, command, value))
        if not self.open:
            if self.strict and self.step < 3 and payload != bytes((self.step,)):
                self.step = 11
            self._sync(payload)
            return
        self.heard_ns = time_ns
        if command in _OBEYED and (value is not None or command in _BARE):
            _OBEYED[command](self, value)
        elif command in {43, 67}:
            self._ask(1 if command == 43 else 2, value)
        elif command in {42, 66} and payload[1] == 0x2B:
            camera = self.cameras.get(1 if command == 42 else 2)
            if camera is not None:
                camera.hear(payload[3 : 3 + payload[2]], time_ns)

    def _enable(self, value):
        self.motors = value == 1 and not self.stop_button

    def _speed(self, value):
        self.speed_mmps, self.wheels, self.way_m = value, None, None

    def _turn(self, value):
        self.turn_degps, self.wheels, self.heading_rad = value, None, None

    def _limit_speed(self, value):
        self.top_mmps = min(abs(value), 750) or 750

    def _limit_turn(self, value):
        self.top_degps = min(abs(value), 100) or 100

    def _move(self, value):
        self.way_m, self.wheels = self._way_m() + value * 1e-3, None

    def _head(self, value):
        self.heading_rad, self.wheels = math.radians(value), None

    def _turn_by(self, value):
        self._head(math.degrees(self._odometry()[2]) + value)

    def _set_origin(self, _value):
        self.zero = self.body.odometry.triple

    def _both_wheels(self, value):
        sides = (value & 0xFFFF).to_bytes(2, "big")
        self.wheels = tuple(0.02 * (side - 256 if side > 127 else side) for side in sides)

    def _stop(self, _value):
        self.speed_mmps = self.turn_degps = 0
        self.wheels = self.way_m = self.heading_rad = None

    def _tell_gripper(self, value):
        self.gripper_stream = value > 1
        if value == 1:
            self._say_gripper()

    def _say_gripper(self):
        if self.knows_gripper_pac:
            self._say(bytes((0xE0, self.gripper_kind, self.body.switches, 0)))

    def _tell_encoders(self, value):
        self.encoder_stream = value > 1
        if value == 1:
            self._say_encoders()

    def _say_encoders(self):
        """Ways of both wheels, in the counts of a robot that has one for a millimetre."""
        way_mm, arc_mm = 1000 * self._way_m(), self._odometry()[2] / 0.006
        self._say(struct.pack("<Bii", 0x90, round(way_mm - arc_mm), round(way_mm + arc_mm)))

    def _switch_sonar(self, value):
        self.sonar = bool(value)

    def _ask(self, port, value):
        self.asked[port] = value
        if value == 0:
            self.aux[port] = b""

    def _sync(self, payload):
        if payload == b"\x00" and self.step < 11:
            self.step = 1
            self._say(b"\x00")
        elif payload == b"\x01" and self.step == 1:
            self.step = 2
            self._say(b"\x01")
        elif payload == b"\x02" and self.step == 2:
            self.step = 3
            self._say(b"\x02Emulated\0Pioneer\0" + self.subclass.encode() + b"\0")
        elif payload[0] == 1 and self.step == 3:
            self.open, self.motors = True, self.motors_at_open
            self.zero = self.body.odometry.triple

    def _sip(self, time_ns):
        body = self.body
        x_m, y_m, heading = self._odometry()
        v, turn = body.base.v_mps * 1000, body.base.omega_radps / 0.006
        stall = 0x3E00 * body.base.bumper | 0x003E * body.base.rear_bumper
        moving = abs(v) > 1 or abs(turn) > 1
        flags = int(self.motors and not self.stop_button) | self.stop_button << 5
        counts = [round(m * 1000 / self.distance_mm) & 0x7FFF for m in (x_m, y_m)]
        units = (round(heading / (2 * math.pi) * 4096) + 2048) % 4096 - 2048
        head = struct.pack("<BHHhhhBHhHB", 0x33 if moving else 0x32, *counts, units, round(v - turn), round(v + turn),
                           124, stall, 0, flags, 0)  # fmt: skip
        if self.empty_sonar and self.sonar:
            return head + bytes((24,))
        gripper = body.gripper_byte if self.tells_gripper else 0
        return head + bytes((0, 0, gripper, 0, body.switches & 0x3F, 0))

    def _odometry(self):
        x0, y0, heading0 = self.zero
        x, y, heading = self.body.odometry.triple
        cos, sin = math.cos(heading0), math.sin(heading0)
        return cos * (x - x0) + sin * (y - y0), cos * (y - y0) - sin * (x - x0), heading - heading0

    def _config(self):
        tops = struct.pack("<B5H", 0, 360, 1500, 300, 2000, 500)
        setup = struct.pack("<BBBHHBHHH", 100, 0, 0, 1, 1, 1, 110, 16570, self.watchdog_ms)
        more = struct.pack("<BHHHHHH", 0, 200, 200, 400, 50, 100, 750)
        return b"\x20Pioneer\0" + self.subclass.encode() + b"\0none\0" + tops + b"Emulated\0" + setup + more


_OBEYED = {
    2: lambda robot, _: robot.reset(),
    4: Robot._enable,
    6: Robot._limit_speed,
    7: Robot._set_origin,
    8: Robot._move,
    9: Robot._turn,
    10: Robot._limit_turn,
    11: Robot._speed,
    12: Robot._head,
    13: Robot._turn_by,
    18: lambda robot, _: robot._say(robot._config()),
    19: Robot._tell_encoders,
    21: Robot._turn,
    22: Robot._turn_by,
    28: Robot._switch_sonar,
    29: Robot._stop,
    32: Robot._both_wheels,
    33: lambda robot, value: robot.body.gripper.tell(value),
    37: Robot._tell_gripper,
    55: Robot._stop,
}
"""Number of a command -> what it does."""
_BARE = {2, 7, 18, 29, 55}
"""Those that need no number."""
