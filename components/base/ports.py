"""The robot base: drive, odometry, gripper, safety: parameters and ports."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from docking.angles import DEG
from runtime.contract import DeviceKind, Input, Kind, Peers, Port, Tick
from runtime.params import between, one_of, positive, ruled, scale
from schemas.drive_pb2 import Applied, BaseCommand, BaseState, Drive

_NAME = r"[A-Za-z_]\w*"
_TOPIC = rf"/?{_NAME}(/{_NAME})*"


def _text(default: str, words: str, pattern: str) -> str:
    """Field of a text that must match as a whole."""
    return ruled(default, words, lambda value: re.fullmatch(pattern, value, re.ASCII) is not None)


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    clock: str = one_of("lockstep", "lockstep", "real")
    """Of the session. In lockstep every frame is answered once and nothing is said between frames."""
    commanders: tuple[str, ...] = ("grasper", "pilot")
    """Who answers every frame; a frame is decided when they have. The others speak when they like."""
    begins_with: tuple[str, ...] = ruled(
        (), "some of teleop, grasper, pilot", {"teleop", "grasper", "pilot"}.issuperset
    )
    """Commanders without whose first word nothing moves: a person who shall have the robot from the start."""
    max_age_s: float = between(0.3, 0.05, 2.0)
    """A command that answers an older frame does not move the robot, and the robot stops when there is no newer."""
    join_s: float = positive(0.02)
    """Real clock: longest wait for a second commander's answer to a frame. One period of `tick`."""
    repeat_s: float = positive(0.1)
    """While stopped for want of a fresh command, the stop is repeated this often."""
    max_speed_mps: float = positive(0.3)
    """Either way. Three times the task's; a person walks beside it."""
    max_turn_rate_radps: float = positive(60 * DEG)
    """Either way."""
    max_acceleration_mps2: float = positive(1.0)
    """Of the command, from frame to frame; slowing down is not limited. The device's own limit is lower."""
    max_turn_acceleration_radps2: float = positive(2.0)
    """As above: a learner's full turn from rest in one frame."""
    speed_scale: float = scale()
    """What the device is told for 1 m/s forwards; -1 = its motors run the other way. `berth check hardware` tells."""
    turn_scale: float = scale()
    """What the device is told for 1 rad/s to the left."""
    odometry_scale: float = scale()
    """Metres forwards for 1 of the device's."""
    heading_scale: float = scale()
    """Radians to the left for 1 of the device's."""
    lift_reversed: bool = False
    """The lift's motor runs the other way round; the device is told so with each command."""
    fingers_reversed: bool = False
    """As above, for the fingers."""
    beams_swapped: bool = False
    """The device's inner break beam is the outer one."""
    inner_beam_inverted: bool = False
    """The device's inner beam reads true while it is whole."""
    outer_beam_inverted: bool = False
    """As above, for the device's outer one."""
    rear_stop_m: float = positive(0.35)
    """No way back with less than this behind the robot. It needs 0.24 m to stop from 0.3 m/s, and a frame to hear of
    it; of a robot without a sensor behind nothing is known."""
    max_reverse_m: float = positive(3.0)
    """Longest way backwards by odometry, until the robot drives forwards again. In 20 simulated minutes: 2.4 m."""
    fence_m: float = positive(4.0)
    """No way back further than this from where the session began, by odometry; make it your room's. In 20 simulated
    minutes: 2.5 m, with 0.1 m of drift."""
    dead_man: str = one_of("never", "never", "reverse", "always")
    """Which motion needs a person who holds the dead-man key, whoever commands; for first runs `reverse`, `always`."""
    stop_when_gone: tuple[str, ...] = ()
    """Components whose death stops the robot, until a frame captured after it is answered."""


@dataclass(frozen=True)
class Pioneer:
    """`device = { kind = "pioneer", port = "/dev/ttyUSB0" }`: ActivMedia's robots (Pioneer 2 and 3, PeopleBot)."""

    port: str = ruled("/dev/ttyUSB0", "a path or tcp://HOST:PORT", bool)
    """Serial port, or `tcp://HOST:8101` of a robot or a simulator in the network."""
    baud: int = positive(9600)
    """Speed of the serial line. Pioneer 2 manual: 9600."""
    search_baud: bool = True
    """If nobody answers, try the other speeds that these robots can be set to."""
    model: str = ruled("auto", "a text", bool)
    """Subclass whose factors count (`pioneer/model.py`); auto = the one that the robot names."""
    gripper: bool = True
    """There is one."""
    beams_obstructed: str = one_of("low", "low", "high")
    """Level of a break beam's line while something is in it. The manuals disagree; `berth check hardware` tells."""
    rear_sonars: tuple[int, ...] = ()
    """Numbers of the sonars that look back, for `rear_range_m`; none = the sonars are switched off."""
    max_speed_mps: float = between(0.5, 0.01, 2.2)
    """Either way; the smaller one of this, the robot's own, and `unattended_m` counts. ARIA's absolute limit: 2.2."""
    max_turn_rate_radps: float = between(60 * DEG, 0.01, 500 * DEG)
    """As above."""
    acceleration_mps2: float = between(0.3, 0.01, 4.0)
    """That the robot is set to, speeding up and braking. PeopleBot manual: 0.3."""
    turn_acceleration_degps2: float = between(100.0, 1.0, 600.0)
    """As above."""
    silent_s: float = between(0.8, 0.2, 5.0)
    """A robot that says nothing for so long (it speaks every 0.1 s) is connected to anew."""
    guard_s: float = between(0.4, 0.1, 2.0)
    """Without a word of base for so long the device stops the robot by itself."""
    watchdog_s: float = between(2.0, 0.05, 60.0)
    """The robot's own, as long as it has not told it."""
    unattended_m: float = between(0.2, 0.01, 1.0)
    """Furthest that the robot may drive by itself, until its own watchdog stops it, if this machine dies: speed is
    limited to this over the watchdog's time. 0.1 m/s with the 2 s that the robots come with."""
    aux: str = ""
    """Path of a socket to be made for the driver of a camera at the robot's auxiliary port; empty = there is none."""
    aux_port: int = between(1, 1, 2)
    """Number of that port. P2OS has only the first."""


@dataclass(frozen=True)
class Ros2:
    """`device = { kind = "ros2", endpoint = "tcp/ROBOT:7447" }`: a robot of ROS 2, over zenoh; needs no ROS here."""

    endpoint: str = _text("tcp/127.0.0.1:7447", "tcp/HOST:PORT", r"tcp/[^/\s]+:\d+")
    """Of the robot's zenoh router: `zenoh-bridge-ros2dds`, or rmw_zenoh's `rmw_zenohd`."""
    bridge: str = one_of("ros2dds", "ros2dds", "rmw_zenoh")
    """`ros2dds`: its nodes speak DDS, and zenoh-bridge-ros2dds runs beside them; `rmw_zenoh`: they speak zenoh."""
    domain: int = between(0, 0, 232)
    """`ROS_DOMAIN_ID`; matters to rmw_zenoh alone."""
    distro: str = one_of("jazzy", "humble", "iron", "jazzy", "kilted", "rolling")
    """The robot's; matters to rmw_zenoh alone: Humble knows no hashes of types."""
    namespace: str = _text("", "a ROS name", rf"({_TOPIC})?")
    """Of topics without a leading slash; that of the robot, or of its bridge."""
    node: str = _text("berth", "a ROS name", _NAME)
    """Our name among the robot's nodes."""
    cmd_vel: str = _text("cmd_vel", "a topic's name", _TOPIC)
    """Takes geometry_msgs/msg/Twist."""
    stamped: bool = False
    """It takes TwistStamped instead (`ros2 topic info cmd_vel` says which); then the robot's clock must be ours."""
    frame: str = ruled("base_link", "at most 64 characters", lambda value: len(value) <= 64)
    """Frame of a TwistStamped."""
    odom: str = _text("odom", "a topic's name", _TOPIC)
    """Says nav_msgs/msg/Odometry, 10 times a second or more."""
    battery: str = _text("", "a topic's name, or empty", rf"({_TOPIC})?")
    """Says sensor_msgs/msg/BatteryState; empty = not read. TurtleBots: `battery_state`."""
    bumper: str = _text("", "a topic's name, or empty", rf"({_TOPIC})?")
    """Empty = not read. TurtleBot 4: `hazard_detection`."""
    bumper_type: str = one_of(
        "irobot_create_msgs/msg/HazardDetectionVector",
        "irobot_create_msgs/msg/HazardDetectionVector",
        "kobuki_ros_interfaces/msg/BumperEvent",
        "std_msgs/msg/Bool",
    )
    """What it says."""
    max_speed_mps: float = between(0.3, 0.01, 2.0)
    """Either way. TurtleBot 3: 0.22 or 0.26, TurtleBot 4: 0.31."""
    max_turn_rate_radps: float = between(60 * DEG, 0.01, 500 * DEG)
    """Either way."""
    silent_s: float = between(1.0, 0.2, 5.0)
    """Without odometry for so long the robot is told to rest, and nothing moves until there is some again."""
    late_s: float = between(0.5, 0.05, 2.0)
    """Odometry that comes so much later than the quickest, by its stamps, counts for nothing."""
    guard_s: float = between(0.4, 0.1, 2.0)
    """Without a word of base for so long the device stops the robot by itself."""
    watchdog_s: float = between(0.0, 0.0, 60.0)
    """The robot's own: how long it drives on after its last command; 0 = not known. Find it out before you trust it."""
    unattended_m: float = between(0.2, 0.01, 1.0)
    """If `watchdog_s` is known: furthest that the robot may drive within it; limits its speed."""


_PIONEER = DeviceKind("components.base.devices.pioneer:Robot", Pioneer, rest="components.base.devices.pioneer:rest")
_ROS2 = DeviceKind("components.base.devices.ros2:Robot", Ros2, rest="components.base.devices.ros2:rest")
DEVICES: Mapping[str, DeviceKind | None] = {"simulator": None, "pioneer": _PIONEER, "ros2": _ROS2}
INPUTS: Mapping[str, Input] = {
    "teleop": Port(Drive, Kind.COMMAND, optional=True),
    "grasper": Port(Drive, Kind.COMMAND, hz=8, optional=True, per_frame=True),
    "pilot": Port(Drive, Kind.COMMAND, hz=8, per_frame=True),
    "device": Port(BaseState, Kind.STATE, hz=8, per_frame=True),
    "tick": Tick(hz=50),
    "gone": Peers(),
}
"""One port per commander, highest priority first."""
_COMMANDS = ("teleop", "grasper", "pilot", "tick", "gone")
OUTPUTS: Mapping[str, Port] = {
    "actuate": Port(BaseCommand, Kind.COMMAND, hz=8, per_frame=True, on=_COMMANDS),
    "applied": Port(Applied, Kind.STATE, hz=8, per_frame=True, on=_COMMANDS),
    "state": Port(BaseState, Kind.STATE, hz=8, per_frame=True, on=("device",)),
    "device": Port(BaseState, Kind.STATE, hz=10),
}
