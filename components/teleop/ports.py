"""A person's keys or gamepad, with a dead-man key: parameters, devices and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from docking.task import Task
from runtime.contract import DeviceKind, Input, Kind, Port, Tick
from runtime.params import between, one_of, ruled
from schemas.drive_pb2 import BaseState, Drive
from schemas.teleop_pb2 import Hands


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    task: Task = field(default_factory=Task)
    """Full speed and full turn are those of its actions, so that what a person does can be learned from."""
    hold_s: float = between(0.2, 0.05, 0.25)
    """A key or a held dead-man button counts for so long; then the robot is told to stop. Keyboards repeat a held key
    every 0.03 to 0.1 s, but the first time only after 0.25 to 0.66 s: the robot pauses there."""
    begin: str = one_of("hand", "hand", "pilot")
    """Who has the robot at the start. In the hand it rests until a key moves it or gives it to the pilot."""
    step: float = between(1.25, 1.01, 2.0)
    """Factor of one step faster or slower."""
    steps: int = between(5, 0, 8)
    """Most steps either way; base has the last word on speed."""


@dataclass(frozen=True)
class Keyboard:
    """`device = { kind = "keyboard" }`: keys of a terminal. See `keys.py` for what each does."""

    port: str = ruled("/dev/tty", "a path", bool)
    """Terminal; /dev/tty is the one that the session was started in."""


@dataclass(frozen=True)
class Gamepad:
    """`device = { kind = "gamepad" }`: a Linux joystick. Numbers as `jstest` shows them, of a common pad."""

    port: str = ruled("/dev/input/js0", "a path", bool)
    """Device file."""
    dead_man_button: int = between(5, 0, 63)
    """Right shoulder: must be held for anything to move."""
    take_button: int = between(7, 0, 63)
    """Start: take the robot, at rest."""
    give_button: int = between(6, 0, 63)
    """Back: give it to the pilot."""
    faster_button: int = between(3, 0, 63)
    """Y."""
    slower_button: int = between(0, 0, 63)
    """A."""
    forward_axis: int = between(1, 0, 63)
    """Left stick; the kernel counts up as negative."""
    left_axis: int = between(0, 0, 63)
    """Left stick; the kernel counts left as negative."""
    dead_zone: float = between(0.15, 0.0, 0.9)
    """A stick nearer to its middle than this is in the middle."""
    still_s: float = between(2.0, 0.2, 60.0)
    """A pad that says nothing for so long is not held any more: a wireless one may have gone without a word."""


KEYS = """q w e / u i o or arrow up: ahead   a d / j l or arrows: turn   z s c / m , . or arrow down: back
hold to drive; any other key: stop   p: to the pilot   t: take   + -: speed   space: dead-man alone"""
_KEYBOARD, _GAMEPAD = "components.teleop.devices.keyboard:Terminal", "components.teleop.devices.gamepad:Joystick"
DEVICES: Mapping[str, DeviceKind] = {
    "keyboard": DeviceKind(_KEYBOARD, Keyboard, terminal=True, usage=KEYS),
    "gamepad": DeviceKind(_GAMEPAD, Gamepad, usage="hold the dead-man button to drive"),
}
INPUTS: Mapping[str, Input] = {
    "device": Port(Hands, Kind.STATE),
    "base": Port(BaseState, Kind.STATE, hz=8),
    "tick": Tick(hz=50),
}
OUTPUTS: Mapping[str, Port] = {
    "drive": Port(Drive, Kind.COMMAND, on=("device", "base", "tick")),
    "device": Port(Hands, Kind.STATE),
}
