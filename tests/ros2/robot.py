"""A ROS 2 base seen from zenoh, in the words of its bridge. Pure: samples and times in, samples out.

It does what real ones do, the awkward included: it obeys the newest Twist, however old; its clock is not ours; its own
timeout may be none (TurtleBot 3); and a node of rmw_zenoh hears nothing that has no attachment.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import NamedTuple

from tests.ros2.messages import (
    HASHES,
    BatteryState,
    HazardDetection,
    HazardDetectionVector,
    Header,
    Odometry,
    Point,
    Pose,
    PoseWithCovariance,
    Quaternion,
    Time,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    Vector3,
)

NS = 1_000_000_000
BOOTED_NS = 1_600_000_000 * NS
"""The robot has no battery for its clock."""
PERIODS_NS = {"odom": NS // 20, "hazard_detection": NS // 10, "battery_state": NS}
BUMP = 1


class Said(NamedTuple):
    key: str
    payload: bytes
    attachment: bytes | None


@dataclass
class Robot:
    """One robot. `body` has wheels and odometry."""

    body: object
    bridge: str = "ros2dds"
    namespace: str = ""
    domain: int = 0
    stamped: bool = False
    timeout_s: float | None = 0.5
    """Its own, for a Twist; None = it has none."""
    mute: bool = False
    """Says nothing; hears all the same."""

    def __post_init__(self):
        self.obeyed = (0.0, 0.0)
        self.heard = []
        """(time, v, omega) of every Twist."""
        self.unheard = 0
        """Messages that rmw_zenoh would not have delivered."""
        self.numbers = []
        """Of the messages, as their attachments say."""
        self.said_ns = {}
        self._number = 0

    @property
    def command_key(self):
        return self.key("cmd_vel", TwistStamped if self.stamped else Twist)

    def key(self, topic, kind):
        name = f"{self.namespace}/{topic}" if self.namespace else topic
        if self.bridge == "ros2dds":
            return name
        package, _, last = kind.__idl__.idl_transformed_typename.rpartition("::dds_::")
        return f"{self.domain}/{name}/{package}::dds_::{last}/{HASHES[kind]}"

    def hear(self, payload, attachment, time_ns):
        """A message on `command_key`."""
        if self.bridge == "rmw_zenoh" and not self._delivers(attachment):
            self.unheard += 1
            return
        said = (TwistStamped if self.stamped else Twist).deserialize(payload)
        twist = said.twist if self.stamped else said
        self.obeyed = (twist.linear.x, twist.angular.z)
        self.heard.append((time_ns, *self.obeyed))

    def _delivers(self, attachment):
        if attachment is None or len(attachment) != 33 or attachment[16] != 16:
            return False
        self.numbers.append(struct.unpack_from("<q", attachment)[0])
        return True

    def twist(self, time_ns):
        """(m/s, rad/s) that the wheels are told now."""
        if not self.heard or (self.timeout_s is not None and time_ns - self.heard[-1][0] > self.timeout_s * NS):
            return 0.0, 0.0
        return self.obeyed

    def speak(self, time_ns):
        """What it says now."""
        if self.mute:
            return []
        made = {"odom": self.odometry, "hazard_detection": self._hazards, "battery_state": self._battery}
        due = [name for name, period in PERIODS_NS.items() if time_ns - self.said_ns.get(name, -NS) >= period]
        self.said_ns.update(dict.fromkeys(due, time_ns))
        return [self.said(name, made[name](time_ns)) for name in due]

    def said(self, topic, message):
        """A message in the bridge's words."""
        self._number += 1
        extra = (
            struct.pack("<qqB16s", self._number, BOOTED_NS, 16, b"\x07" * 16) if self.bridge == "rmw_zenoh" else None
        )
        return Said(self.key(topic, type(message)), message.serialize(), extra)

    def header(self, time_ns, frame):
        return Header(Time((BOOTED_NS + time_ns) // NS, (BOOTED_NS + time_ns) % NS), frame)

    def odometry(self, time_ns):
        x, y, heading = self.body.odometry.triple
        pose = Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)))
        twist = Twist(Vector3(x=self.body.base.v_mps), Vector3(z=self.body.base.omega_radps))
        return Odometry(self.header(time_ns, "odom"), "base_link", PoseWithCovariance(pose, [0.0] * 36),
                        TwistWithCovariance(twist, [0.0] * 36))  # fmt: skip

    def _hazards(self, time_ns):
        bumps = [HazardDetection(self.header(time_ns, "bump_front_center"), BUMP)] * self.body.base.bumper
        return HazardDetectionVector(self.header(time_ns, "base_link"), bumps)

    def _battery(self, time_ns):
        return BatteryState(self.header(time_ns, ""), 12.5, math.nan, -0.5, math.nan, math.nan, 1.8, 0.9, 2, 1, 3, True,
                            [], [], "base", "")  # fmt: skip
