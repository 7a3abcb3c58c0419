"""What a person's hands command: the newest reading counts for a fraction of a second, then the robot stands."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import NamedTuple

from components.teleop.ports import Params

NS = 1_000_000_000
"""Nanoseconds in a second."""


class Request(IntEnum):
    """Numbers of `berth.Hands.Request`."""

    NOTHING = 0
    TAKE = 1
    GIVE = 2
    FASTER = 3
    SLOWER = 4


class Hand(NamedTuple):
    """One reading."""

    dead_man: bool = False
    forward: float = 0.0
    """-1 to 1."""
    left: float = 0.0
    """-1 to 1."""
    request: int = Request.NOTHING


OPEN = Hand()
"""Nothing is held."""


class Command(NamedTuple):
    """What base is told."""

    engaged: bool = False
    v_mps: float = 0.0
    omega_radps: float = 0.0
    dead_man: bool = False


@dataclass(frozen=True, slots=True)
class Grip:
    """Who has the robot, and how fast it goes."""

    has_robot: bool
    """The person has it: it moves by the keys alone, and rests without."""
    steps: int = 0
    """Faster (positive) or slower than the task's speed."""
    hand: Hand = OPEN
    """Newest reading."""
    read_ns: int = -1
    """Its time."""


def read(params: Params, grip: Grip, hand: Hand, time_ns: int) -> Grip:
    """Take a reading. Whoever moves the robot by hand has taken it; it is given back only on request."""
    moves = hand.dead_man and (hand.forward != 0.0 or hand.left != 0.0)
    request = hand.request
    has_robot = (grip.has_robot or moves or request == Request.TAKE) and request != Request.GIVE
    steps = grip.steps + (request == Request.FASTER) - (request == Request.SLOWER)
    steps = min(max(steps, -params.steps), params.steps)
    if request in (Request.FASTER, Request.SLOWER):
        return replace(grip, steps=steps)  # a step while driving does not let go of the stick
    return Grip(has_robot, steps, hand, time_ns)


def command(params: Params, grip: Grip, time_ns: int) -> Command:
    """What base is told now."""
    held = grip.hand.dead_man and 0 <= time_ns - grip.read_ns <= params.hold_s * NS
    if not (held and grip.has_robot):
        return Command(engaged=grip.has_robot, dead_man=held)
    speed, turn = params.task.actions[0]
    factor = params.step**grip.steps
    return Command(True, grip.hand.forward * speed * factor, grip.hand.left * turn * factor, True)
