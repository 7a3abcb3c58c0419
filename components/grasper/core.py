"""The hand-coded pick-up (Martinez-Marin and Duckett 2005, section VI) as stages with a time limit each."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

from components.grasper.ports import Params

NS = 1_000_000_000
"""Nanoseconds in a second."""


class Stage(IntEnum):
    """Numbers of `berth.Grasp.Stage`."""

    IDLE = 0
    LOWERING = 1
    CLOSING = 2
    LIFTING = 3
    RELEASING = 4
    DONE = 5


class Action(IntEnum):
    """Numbers of `berth.GripperAction`."""

    KEEP = 0
    LOWER = 1
    CLOSE = 2
    LIFT = 3
    RELEASE = 4


class Gripper(NamedTuple):
    """What the gripper's switches said last, and when."""

    capture_ns: int = -1
    inner_beam: bool = False
    outer_beam: bool = False
    lift_up: bool = False
    lift_down: bool = False
    fingers_closed: bool = False


class PickUp(NamedTuple):
    """Where the pick-up is."""

    stage: Stage = Stage.IDLE
    began_ns: int = -1
    """Capture time of the frame that began the stage."""
    picked: bool = False


ACTIONS = {
    Stage.IDLE: Action.KEEP,
    Stage.LOWERING: Action.LOWER,
    Stage.CLOSING: Action.CLOSE,
    Stage.LIFTING: Action.LIFT,
    Stage.RELEASING: Action.RELEASE,
    Stage.DONE: Action.KEEP,
}
"""What the gripper is told in each stage."""


def sees_object(gripper: Gripper, beams: str) -> bool:
    """Whether the beams that count are broken."""
    broken = (gripper.inner_beam, gripper.outer_beam)
    return {"both": all(broken), "any": any(broken), "inner": broken[0], "outer": broken[1]}[beams]


def step(params: Params, now: PickUp, gripper: Gripper, wanted: bool, time_ns: int) -> PickUp:
    """The pick-up in the next frame.

    A switch counts only if it was read after the stage began: the end switch of the stage before may still be closed.
    Leaving while the gripper is anywhere but idle spends one frame in RELEASING.
    """
    if not wanted:
        resting = now.stage in (Stage.IDLE, Stage.RELEASING)
        return PickUp(Stage.IDLE if resting else Stage.RELEASING, time_ns)
    if now.stage == Stage.IDLE:
        return PickUp(Stage.LOWERING, time_ns)
    stage, picked = _FOLLOWING[now.stage](params, now, _Look(gripper, now.began_ns, params.beams, time_ns))
    return now if stage == now.stage else PickUp(stage, time_ns, picked)


class _Look:
    """The gripper as far as it was read since the stage began."""

    def __init__(self, gripper: Gripper, began_ns: int, beams: str, time_ns: int) -> None:
        fresh = gripper.capture_ns > began_ns
        self.seen = fresh and sees_object(gripper, beams)
        self.up = fresh and gripper.lift_up
        self.down = fresh and gripper.lift_down
        self.closed = fresh and gripper.fingers_closed
        self.since_s = (time_ns - began_ns) / NS


def _lowering(params: Params, now: PickUp, look: _Look) -> tuple[Stage, bool]:
    if look.seen:
        return Stage.CLOSING, False
    missed = look.down or look.since_s > params.lower_s
    return (Stage.RELEASING if missed else now.stage), False


def _closing(params: Params, now: PickUp, look: _Look) -> tuple[Stage, bool]:
    return (Stage.LIFTING if look.closed or look.since_s > params.close_s else now.stage), False


def _lifting(params: Params, now: PickUp, look: _Look) -> tuple[Stage, bool]:
    if look.up:
        return Stage.DONE, look.seen
    return (Stage.RELEASING if look.since_s > params.lift_s else now.stage), False


def _releasing(params: Params, now: PickUp, look: _Look) -> tuple[Stage, bool]:
    return (Stage.DONE if look.up or look.since_s > params.release_s else now.stage), False


def _done(_params: Params, now: PickUp, _look: _Look) -> tuple[Stage, bool]:
    return now.stage, now.picked


_FOLLOWING: dict[Stage, Callable[[Params, PickUp, _Look], tuple[Stage, bool]]] = {
    Stage.LOWERING: _lowering,
    Stage.CLOSING: _closing,
    Stage.LIFTING: _lifting,
    Stage.RELEASING: _releasing,
    Stage.DONE: _done,
}
