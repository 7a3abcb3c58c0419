"""The base's client: samples and commands in, samples and readings out; time is an argument. Pure.

Whatever the robot says or does not say, it is told to rest: when its odometry stops, when the commands stop coming, and
at the end. How long it drives on by itself is not known, so it is told ten times a second.
"""

from __future__ import annotations

from collections import Counter, deque
from typing import NamedTuple

from components.base.motion import NS
from components.base.ports import Ros2
from components.base.ros2 import twist
from components.base.ros2.bridge import bridge_of
from components.base.ros2.bumper import Bumper, Contact
from components.base.ros2.codec import BATTERY, ODOMETRY, TWIST, TWIST_STAMPED, MalformedError, decoded
from components.base.ros2.lateness import Lateness
from components.base.ros2.odometry import Odometry, odometry_of
from components.base.ros2.topic import Topic, absolute

FAREWELLS = 5
"""Times that a robot is told to rest before it is left: messages may be lost."""
_REPEAT_NS = NS // 10
_MUTE_NS = NS // 5
"""While the robot says nothing, its absence is told this often."""
_READING_NS = NS // 25
"""No more readings than these; robots say their odometry up to 200 times a second."""
_MOST = 32
"""Readings and words that wait to be taken."""
_MOST_V = 100.0


class Sample(NamedTuple):
    """A message on its way to the robot."""

    payload: bytes
    attachment: bytes | None


class Reading(NamedTuple):
    """What the robot says."""

    time_ns: int
    """When it was so, as far as stamps tell."""
    odometry: Odometry
    contact: Contact
    battery_v: float
    fault: str
    """Why it must not be moved; empty = it may."""


class Client:
    """One robot."""

    def __init__(self, params: Ros2, zid: str, time_ns: int) -> None:
        """Nothing is known of it.

        Args:
            params: of the device.
            zid: id of the zenoh session.
            time_ns: now.
        """
        self._params = params
        self._bridge = bridge_of(params, zid)
        wanted = self._topic(params.cmd_vel, TWIST_STAMPED if params.stamped else TWIST)
        listened = [self._topic(params.odom, ODOMETRY)]
        listened += [self._topic(params.battery, BATTERY)] if params.battery else []
        listened += [self._topic(params.bumper, params.bumper_type)] if params.bumper else []
        self.command_key = self._bridge.key(wanted)
        self.keys = {self._bridge.key(topic): topic for topic in listened}
        """Keys to subscribe to."""
        self.tokens = self._bridge.tokens([wanted], listened)
        """Keys of the liveliness tokens to declare."""
        self._bumper = Bumper(params.bumper_type)
        self._lateness = Lateness()
        self._odometry = Odometry(0.0, 0.0, 0.0, 0.0, 0.0, 0)
        self._silence = f"no odometry on {listened[0].name}"
        """Why nothing may move; empty = odometry comes."""
        self._battery_v = 0.0
        self._wish = twist.STILL
        self._heard_ns = self._told_ns = time_ns
        self._commanded_ns: int | None = None
        self._said_ns: int | None = None
        self._sequence = 0
        self.refused: Counter[str] = Counter()
        """Messages that counted for nothing, by topic."""
        self.readings: deque[Reading] = deque(maxlen=_MOST)
        self.words: deque[str] = deque(maxlen=_MOST)
        """For a person."""

    @property
    def fault(self) -> str:
        """Why nothing may move; empty = it may."""
        return self._silence or self._bumper.contact.fault

    def take(self, key: str, payload: bytes, time_ns: int) -> None:
        """A sample of the robot; one that is malformed, late or absurd counts for nothing, and is counted."""
        topic = self.keys[key]
        try:
            if topic.type == ODOMETRY:
                self._take_odometry(odometry_of(payload), time_ns)
            elif topic.type == BATTERY:
                self._take_battery(decoded(BATTERY, payload).voltage)
            else:
                self._take_contact(payload, time_ns)
        except MalformedError as error:
            self.refused[topic.name] += 1
            if self.refused[topic.name] == 1:
                self.words.append(f"refused from {topic.name}: {error}")

    def command(self, v_mps: float, omega_radps: float, time_ns: int) -> None:
        """What base wants from now on; it must say so again and again."""
        self._commanded_ns = time_ns
        self._wish = twist.STILL if self.fault else twist.limited(v_mps, omega_radps, self._params)
        self._said_ns = None

    def advance(self, time_ns: int) -> None:
        """Stop what nobody answers for any more."""
        if self._commanded_ns is not None and time_ns - self._commanded_ns > self._params.guard_s * NS:
            self._rest()
        if not self._silence and time_ns - self._heard_ns > self._params.silent_s * NS:
            self._silence = f"no odometry for {self._params.silent_s:g} s"
            self.words.append(f"{self._silence}; the robot is told to rest")
            self._rest()
        if self._silence and time_ns - self._told_ns >= _MUTE_NS:
            self._tell(time_ns, time_ns)

    def sample(self, time_ns: int, wall_ns: int) -> Sample | None:
        """What is to be said on `command_key` now, if anything."""
        if self._said_ns is not None and time_ns - self._said_ns < _REPEAT_NS:
            return None
        self._said_ns = time_ns
        return self._sample(self._wish, wall_ns)

    def farewell(self, wall_ns: int) -> tuple[Sample, ...]:
        """The last words, one after the other."""
        return tuple(self._sample(twist.STILL, wall_ns) for _ in range(FAREWELLS))

    def _topic(self, name: str, kind: str) -> Topic:
        return Topic(absolute(self._params.namespace, name), kind)

    def _sample(self, what: twist.Twist, wall_ns: int) -> Sample:
        self._sequence += 1
        payload = twist.payload(what, wall_ns, self._params)
        return Sample(payload, self._bridge.attachment(self._sequence, wall_ns))

    def _take_odometry(self, odometry: Odometry, time_ns: int) -> None:
        if self._silence and self._lateness.is_set_anew(odometry.stamp_ns, time_ns):
            self._lateness = Lateness()
        late_s = self._lateness.late_s(odometry.stamp_ns, time_ns)
        if late_s is None:
            raise MalformedError("an older one came later")
        if late_s > self._params.late_s:
            raise MalformedError(f"{late_s:.1f} s late")
        self._heard_ns, self._odometry = time_ns, odometry
        if self._silence:
            self._silence = ""
            self.words.append("odometry comes")
        if time_ns - self._told_ns >= _READING_NS:
            self._tell(time_ns - round(late_s * NS), time_ns)

    def _take_battery(self, voltage: float) -> None:
        if not 0.0 < voltage < _MOST_V:
            raise MalformedError(f"{voltage:g} V is no battery")
        self._battery_v = float(voltage)

    def _take_contact(self, payload: bytes, time_ns: int) -> None:
        before = self._bumper.contact
        self._bumper.take(payload)
        if self._bumper.contact != before:
            if self._bumper.contact.fault:
                self._rest()
            self._tell(time_ns, time_ns)

    def _tell(self, measured_ns: int, time_ns: int) -> None:
        self._told_ns = time_ns
        self.readings.append(Reading(measured_ns, self._odometry, self._bumper.contact, self._battery_v, self.fault))

    def _rest(self) -> None:
        if self._wish != twist.STILL:
            self._wish, self._said_ns = twist.STILL, None
