"""The gripper: a lift, two fingers, and two horizontal break beams between them."""

from __future__ import annotations

from enum import IntEnum

from components.simulator.params import Params


class Action(IntEnum):
    """What the gripper is doing; the numbers of `berth.GripperAction`."""

    KEEP = 0
    LOWER = 1
    CLOSE = 2
    LIFT = 3
    RELEASE = 4


LOW = 0.1
"""Share of the lift's stroke below which the fingers and beams are at the object's height."""
RAISED = 0.1
"""Share of the lift's stroke above which a gripped object counts as lifted."""


class Gripper:
    """Lift height in 0 (down) .. 1 (up), fingers in 0 (shut) .. 1 (open)."""

    def __init__(self, params: Params) -> None:
        self._params = params
        self.lift = 1.0
        self.fingers = 1.0
        self.gripping = False
        self._action = Action.LIFT
        self._lift_reversed = self._fingers_reversed = False

    def command(self, action: int, lift_reversed: bool = False, fingers_reversed: bool = False) -> None:
        """Begin an action, its motors the other way round if so said; KEEP and unknown numbers go on with the last."""
        if action in {Action.LOWER, Action.CLOSE, Action.LIFT, Action.RELEASE}:
            self._action = Action(action)
            self._lift_reversed, self._fingers_reversed = lift_reversed, fingers_reversed

    def begin_lowered(self) -> None:
        """Be down, with open fingers."""
        self.lift, self._action = 0.0, Action.LOWER

    def step(self, ahead_m: float, left_m: float, dt_s: float) -> None:
        """Move for `dt_s`. The object's centre is `ahead_m`, `left_m` of the gripper point while it is not gripped."""
        match self._action:
            case Action.LOWER:
                self._move_fingers(True, ahead_m, left_m, dt_s)
                self._move_lift(False, dt_s)
            case Action.CLOSE:
                self._move_fingers(False, ahead_m, left_m, dt_s)
            case Action.LIFT:
                self._move_lift(True, dt_s)
            case Action.RELEASE:
                self._move_fingers(True, ahead_m, left_m, dt_s)
                self._move_lift(True, dt_s)
            case _:
                pass

    def _move_lift(self, up: bool, dt_s: float) -> None:
        if up != self._lift_reversed:
            self.lift = min(1.0, self.lift + dt_s / self._params.lift_s)
        else:
            self.lift = max(0.0, self.lift - dt_s / self._params.lower_s)

    def _move_fingers(self, apart: bool, ahead_m: float, left_m: float, dt_s: float) -> None:
        if apart != self._fingers_reversed:
            self._open(dt_s)
        else:
            self._close(ahead_m, left_m, dt_s)

    def _open(self, dt_s: float) -> None:
        self.gripping = False
        self.fingers = min(1.0, self.fingers + dt_s / self._params.close_s)

    def _close(self, ahead_m: float, left_m: float, dt_s: float) -> None:
        within = self.gripping or (
            self.lift < LOW and abs(ahead_m) <= self._params.grip_depth_m and abs(left_m) <= self._clearance_m
        )
        stop = self._params.object_diameter_m / self._params.opening_m if within else 0.0
        self.fingers = max(stop, self.fingers - dt_s / self._params.close_s)
        self.gripping = within and self.fingers <= stop

    @property
    def _clearance_m(self) -> float:
        """How far aside the object passes between the open fingers; closing, they push it to their middle."""
        return 0.5 * (self._params.opening_m - self._params.object_diameter_m)

    def beams(self, ahead_m: float, left_m: float) -> tuple[bool, bool]:
        """(inner, outer): is the beam broken?"""
        if self.gripping:
            return True, True
        if self.lift >= LOW or self.fingers <= 0.0 or abs(left_m) > 0.5 * self._params.opening_m:
            return False, False
        radius_m = 0.5 * self._params.object_diameter_m
        return (
            abs(ahead_m - self._params.inner_beam_m) <= radius_m,
            abs(ahead_m - self._params.outer_beam_m) <= radius_m,
        )

    @property
    def up(self) -> bool:
        """End switch at the top."""
        return self.lift >= 1.0

    @property
    def down(self) -> bool:
        """End switch at the bottom."""
        return self.lift <= 0.0

    @property
    def closed(self) -> bool:
        """The fingers stand still after a close: shut, or on the object."""
        return self.gripping or self.fingers <= 0.0

    @property
    def holding(self) -> bool:
        """The object is in the fingers and off the table."""
        return self.gripping and self.lift > RAISED
