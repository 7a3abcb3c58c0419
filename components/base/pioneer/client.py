"""The robot's client: bytes and commands in, bytes and readings out; time is an argument. Pure.

Whatever the robot does or does not say, it is told to rest: before anything else, after a silence of ours, when the
commands stop coming. It is stopped once and not enabled again by its stop button: a person does that at the robot.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from components.base.pioneer import aux_pac
from components.base.pioneer.command import Command, integer, plain
from components.base.pioneer.config_pac import ConfigPac, config_of
from components.base.pioneer.frame import Frames
from components.base.pioneer.gripper import Gripper, Switches
from components.base.pioneer.gripper_flags import flags_of
from components.base.pioneer.gripper_pac import NO_GRIPPER, GripperPac, gripper_of
from components.base.pioneer.handshake import REST, Handshake
from components.base.pioneer.model import DEFAULT, MODELS, Model
from components.base.pioneer.odometry import Odometry
from components.base.pioneer.outbox import Outbox
from components.base.pioneer.setpoint import STILL, Limits, Rounding
from components.base.pioneer.sip import Sip, sip_of
from components.base.ports import Pioneer

_NS = 1_000_000_000
_MUTE_NS = _NS // 5
"""While the robot says nothing, its absence is told this often."""
_SETTLE_NS = 100_000_000
"""A line without a byte for so long is at rest, and no packet is on its way."""
_CONFIG_NS = _NS
"""The configuration is asked for again after this."""
_GRIPPER_NS = _NS
"""A robot that has sent no GRIPPERpac by then knows none."""
_SLOW_WATCHDOG_MS = 500
_NO_WATCHDOG_MS = 60_000
_MOST = 32
"""Readings, answers and words that wait to be taken."""


class Wish(NamedTuple):
    """What base wants."""

    v_mps: float = 0.0
    omega_radps: float = 0.0
    gripper: int = 0
    lift_reversed: bool = False
    fingers_reversed: bool = False


class Reading(NamedTuple):
    """What the robot says."""

    x_m: float
    y_m: float
    heading_rad: float
    v_mps: float = 0.0
    omega_radps: float = 0.0
    bumper: bool = False
    rear_bumper: bool = False
    switches: Switches = Switches()
    rear_range_m: float | None = None
    battery_v: float = 0.0
    fault: str = ""
    """Why it must not be moved; empty = it may."""
    watchdog_s: float = 0.0
    """Its own."""


class Client:
    """One robot at one line, from its handshake on, again and again."""

    def __init__(self, params: Pioneer, time_ns: int) -> None:
        self._params = params
        self._frames = Frames()
        self._odometry = Odometry(MODELS[DEFAULT])
        self._rounding = Rounding()
        self._gripper = Gripper(params.beams_obstructed == "high")
        self._outbox = Outbox()
        self._handshake: Handshake | None = None
        self._sonar: dict[int, int] = {}
        self._heard_ns = self._byte_ns = self._told_ns = self._config_ns = time_ns
        self._commanded_ns: int | None = None
        self._opened_ns = time_ns
        self._gripper_kind: int | None = None
        """As the newest GRIPPERpac tells; None = none has come."""
        self._fault = ""
        self.model: Model = MODELS[DEFAULT]
        self.config: ConfigPac | None = None
        self.readings: deque[Reading] = deque(maxlen=_MOST)
        self.answers: deque[bytes] = deque(maxlen=_MOST)
        """What the device at the auxiliary port has said."""
        self.words: deque[str] = deque(maxlen=_MOST)
        """For a person."""
        self.begin(time_ns)

    @property
    def is_open(self) -> bool:
        """The robot answers and is told what to do."""
        return self._handshake is None

    @property
    def failed(self) -> bool:
        """Nobody has answered the handshake: try another speed, or open the port again, then `begin`."""
        return self._handshake is not None and self._handshake.failed

    @property
    def waits(self) -> bool:
        """Whether more is to be written soon."""
        return self._outbox.waits

    def begin(self, time_ns: int, fresh: bool = True) -> None:
        """Greet the robot, of which nothing is known.

        Args:
            time_ns: now.
            fresh: over a line that has just been opened.
        """
        self._frames = Frames()
        self._outbox.clear()
        self._handshake = Handshake(time_ns, listens=fresh and self._params.port.startswith("tcp:"))
        self._byte_ns = time_ns
        self.advance(time_ns)

    def take(self, data: bytes, time_ns: int) -> None:
        """Bytes of the robot."""
        self._byte_ns = time_ns
        for payload in self._frames.feed(data):
            self._understand(payload, time_ns)

    def command(self, wish: Wish, time_ns: int) -> None:
        """What base wants from now on; it must say so again and again."""
        self._commanded_ns = time_ns
        if not self.is_open:
            return
        self._outbox.point = STILL if self._fault else self._rounding.rounded(wish.v_mps, wish.omega_radps, self.limits)
        if self._params.gripper:
            packets = self._gripper.command(wish.gripper, wish.lift_reversed, wish.fingers_reversed, time_ns)
            self._outbox.add(packets)

    def ask(self, content: bytes, answer_bytes: int) -> None:
        """Say something to the device at the auxiliary port, and wait for so many bytes."""
        if self.is_open:
            self._outbox.add(aux_pac.asked(content, answer_bytes, self._params.aux_port))

    def advance(self, time_ns: int) -> None:
        """Do what is due."""
        if time_ns - self._byte_ns >= _SETTLE_NS:
            for payload in self._frames.settle():
                self._understand(payload, time_ns)
        if self._handshake is not None:
            self._outbox.add(self._handshake.advance(time_ns))
        elif time_ns - self._heard_ns >= self._params.silent_s * _NS:
            self._say(f"nothing from the robot for {self._params.silent_s:g} s; connecting anew")
            self.begin(time_ns, fresh=False)
        elif self.config is None and time_ns - self._config_ns >= _CONFIG_NS:
            self._config_ns = time_ns
            self._outbox.add((integer(Command.CONFIG, 1),))
        if self._commands_stopped(time_ns):
            self._outbox.point = STILL
        if not self.is_open and time_ns - self._told_ns >= _MUTE_NS:
            self._tell(time_ns, Reading(*self._pose, fault="not connected"))

    def packet(self, time_ns: int, baud: int) -> bytes:
        """The packet to be written now; empty = none."""
        return self._outbox.next(time_ns, baud)

    def farewell(self) -> tuple[bytes, ...]:
        """Packets that leave the robot at rest."""
        return (*REST, plain(Command.STOP), plain(Command.CLOSE))

    @property
    def limits(self) -> Limits:
        """The smallest of ours, the robot's, and what its watchdog lets it drive unattended."""
        speed, turn = self._params.max_speed_mps, self._params.max_turn_rate_radps
        config = self.config
        speed = min(speed, self._params.unattended_m / self._watchdog_s)
        if config is not None and config.fastest_mmps is not None:
            speed = min(speed, config.fastest_mmps * 1e-3)
        if config is not None and config.fastest_turn_degps is not None:
            turn = min(turn, config.fastest_turn_degps * 0.017453292519943295)
        return Limits(speed, turn)

    @property
    def _watchdog_s(self) -> float:
        """The robot's own, as it has told it; one that is off is a long one."""
        config = self.config
        return self._params.watchdog_s if config is None else 1e-3 * (config.watchdog_ms or _NO_WATCHDOG_MS)

    @property
    def _pose(self) -> tuple[float, float, float]:
        return self._odometry.x_m, self._odometry.y_m, self._odometry.heading_rad

    def _understand(self, payload: bytes, time_ns: int) -> None:
        if self._handshake is not None:
            self._outbox.add(self._handshake.take(payload, time_ns))
            if self._handshake.names is not None:
                self._open(self._handshake.names, time_ns)
            return
        sip, gripper, answer = sip_of(payload), gripper_of(payload), aux_pac.answer_of(payload, self._params.aux_port)
        if sip is not None:
            self._heard_ns = time_ns
            self._read(sip, time_ns)
        elif gripper is not None and self._params.gripper:
            self._see_gripper(gripper, time_ns)
        elif answer is not None:
            self.answers.append(answer)
        elif self.config is None and (config := config_of(payload)) is not None:
            self._configure(config)

    def _open(self, names: tuple[str, str, str], time_ns: int) -> None:
        wanted = self._params.model if self._params.model != "auto" else names[2].lower()
        self.model = MODELS.get(wanted, MODELS[DEFAULT])
        self._say(f"connected to {names[0] or 'a robot'}, {names[1]} {names[2]}".rstrip())
        if wanted not in MODELS:
            self._say(f"model {wanted!r} is unknown, {DEFAULT} is assumed; known are {', '.join(MODELS)}")
        self._handshake, self.config, self._sonar = None, None, {}
        self._odometry.forget(self.model)
        self._heard_ns = self._config_ns = self._opened_ns = time_ns
        self._gripper_kind = None
        self._rounding = Rounding()
        self._outbox.add(self._setup())
        self._outbox.drives = True

    def _setup(self) -> tuple[bytes, ...]:
        params = self._params
        acceleration, turn_acceleration = round(params.acceleration_mps2 * 1000), round(params.turn_acceleration_degps2)
        packets = [
            plain(Command.OPEN),
            *REST,
            integer(Command.CONFIG, 1),
            integer(Command.SETV, round(params.max_speed_mps * 1000)),
            integer(Command.SETRV, round(params.max_turn_rate_radps * 57.29577951308232)),
            integer(Command.SETA, acceleration),
            integer(Command.SETA, -acceleration),
            integer(Command.SETRA, turn_acceleration),
            integer(Command.SETRA, -turn_acceleration),
            integer(Command.SONAR, int(bool(params.rear_sonars))),
        ]
        if params.gripper:
            packets.append(integer(Command.GRIPREQUEST, 2))
        return (*packets, integer(Command.ENABLE, 1))

    def _configure(self, config: ConfigPac) -> None:
        self.config = config
        watchdog = f"{config.watchdog_ms} ms" if config.watchdog_ms else "off"
        if not 0 < config.watchdog_ms <= _SLOW_WATCHDOG_MS:
            self._say(
                f"the robot's own watchdog is {watchdog}; 500 ms or less is safer (set it in FLASH). "
                f"Until then no faster than {self.limits.speed_mps:.3f} m/s, slower near the table"
            )

    def _see_gripper(self, pac: GripperPac, time_ns: int) -> None:
        if pac.kind == NO_GRIPPER and self._gripper_kind != NO_GRIPPER:
            self._say("the robot says that it has no gripper")
        self._gripper_kind = pac.kind
        if pac.kind != NO_GRIPPER:
            self._gripper.see(pac, time_ns)

    def _see_flags(self, sip: Sip, time_ns: int) -> None:
        """Of firmware without GRIPPERpac, what the standard packet says must do."""
        flags = flags_of(sip)
        if flags is None or self._gripper_kind == NO_GRIPPER:
            return
        if self._gripper_kind is not None:
            self._gripper.hear(flags)
        elif time_ns - self._opened_ns >= _GRIPPER_NS:
            self._gripper.see_flags(flags, time_ns)

    def _read(self, sip: Sip, time_ns: int) -> None:
        self._odometry.add(sip, time_ns)
        if self._params.gripper:
            self._see_flags(sip, time_ns)
        self._sonar.update(sip.sonar)
        model = self.model
        fault = self._fault_of(sip, time_ns)
        if fault:
            self._outbox.point = STILL
        if fault != self._fault:
            self._say(f"stopped: {fault}" if fault else "may move")
        self._fault = fault
        reading = Reading(
            *self._pose,
            v_mps=0.5e-3 * model.speed * (sip.left + sip.right),
            omega_radps=0.5 * model.turn * model.speed * (sip.right - sip.left),
            bumper=sip.front_bumper,
            rear_bumper=sip.rear_bumper,
            switches=self._gripper.switches,
            rear_range_m=self._rear_range_m(),
            battery_v=0.1 * sip.battery_dv,
            fault=fault,
            watchdog_s=self._watchdog_s,
        )
        self._tell(time_ns, reading)

    def _tell(self, time_ns: int, reading: Reading) -> None:
        self._told_ns = time_ns
        self.readings.append(reading)

    def _fault_of(self, sip: Sip, time_ns: int) -> str:
        if sip.stop_button:
            return "stop button"
        if not sip.motors_on:
            return "motors off"
        if sip.stalled:
            return "stalled"
        return "no command" if self._commands_stopped(time_ns) else ""

    def _commands_stopped(self, time_ns: int) -> bool:
        """Whether whoever has moved the robot has fallen silent."""
        return self._commanded_ns is not None and time_ns - self._commanded_ns > self._params.guard_s * _NS

    def _rear_range_m(self) -> float | None:
        ranges = [self._sonar[number] for number in self._params.rear_sonars if number in self._sonar]
        return min(ranges) * self.model.range_mm * 1e-3 if ranges else None

    def _say(self, words: str) -> None:
        self.words.append(words)
