"""The gripper by its commands and switches: what it is told, and what a pick-up needs to know of it. Pure.

GRIPPERpac's one switch says that the lift is at an end, not at which. Unless the standard packet tells, it is the one
that the lift was last sent to, if it has moved since. Commands are repeated, because nobody acknowledges them.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from components.base.pioneer.command import Command, integer
from components.base.pioneer.gripper_flags import GripperFlags
from components.base.pioneer.gripper_pac import GripperPac

_NS = 1_000_000_000
_REPEAT_NS = _NS
_PATIENCE_NS = _NS
"""A motor that has not been seen moving for so long was there already."""


class Action(IntEnum):
    """Numbers of `berth.GripperAction`."""

    KEEP = 0
    LOWER = 1
    CLOSE = 2
    LIFT = 3
    RELEASE = 4


class Code(IntEnum):
    """Arguments of GRIPPER. Pioneer Gripper Manual."""

    OPEN = 1
    CLOSE = 2
    LIFT_UP = 4
    LIFT_DOWN = 5


_OPPOSITE = {Code.OPEN: Code.CLOSE, Code.CLOSE: Code.OPEN, Code.LIFT_UP: Code.LIFT_DOWN, Code.LIFT_DOWN: Code.LIFT_UP}
_FINGERS = {Action.LOWER: Code.OPEN, Action.CLOSE: Code.CLOSE, Action.RELEASE: Code.OPEN}
_LIFT = {Action.LOWER: Code.LIFT_DOWN, Action.LIFT: Code.LIFT_UP, Action.RELEASE: Code.LIFT_UP}


class Switches(NamedTuple):
    """What a pick-up needs to know."""

    inner_beam: bool = False
    outer_beam: bool = False
    lift_up: bool = False
    lift_down: bool = False
    fingers_closed: bool = False


class _Motor:
    """One of both, as it was told and seen."""

    def __init__(self) -> None:
        self.code: Code | None = None
        self.told_ns = 0
        self.moved = False

    def tell(self, code: Code, time_ns: int) -> None:
        if code != self.code:
            self.code, self.told_ns, self.moved = code, time_ns, False

    def arrived(self, code: Code, moves: bool, time_ns: int) -> bool:
        """Whether it has done this."""
        self.moved = self.moved or moves
        return self.code == code and not moves and (self.moved or time_ns - self.told_ns >= _PATIENCE_NS)


class Gripper:
    """Turns actions into packets and packets into switches."""

    def __init__(self, obstructed_high: bool) -> None:
        self._obstructed_high = obstructed_high
        self._lift, self._fingers = _Motor(), _Motor()
        self._reversed = (False, False)
        self._said_ns = 0
        self._flags: GripperFlags | None = None
        self.switches = Switches()

    def command(self, action: int, lift_reversed: bool, fingers_reversed: bool, time_ns: int) -> tuple[bytes, ...]:
        """Packets that begin an action, or say again what it was."""
        before = (self._lift.code, self._fingers.code, self._reversed)
        if action in _FINGERS:
            self._fingers.tell(_FINGERS[Action(action)], time_ns)
        if action in _LIFT:
            self._lift.tell(_LIFT[Action(action)], time_ns)
        self._reversed = (lift_reversed, fingers_reversed)
        if before == (self._lift.code, self._fingers.code, self._reversed) and time_ns - self._said_ns < _REPEAT_NS:
            return ()
        self._said_ns = time_ns
        wanted = ((self._fingers.code, fingers_reversed), (self._lift.code, lift_reversed))
        codes = (_OPPOSITE[code] if turned else code for code, turned in wanted if code is not None)
        return tuple(integer(Command.GRIPPER, code) for code in codes)

    def see(self, pac: GripperPac, time_ns: int) -> None:
        """Take a packet."""
        inner, outer = self._obstructed(pac.inner_beam), self._obstructed(pac.outer_beam)
        at_end = pac.lift_at_end
        lift_moves = pac.lift_moves or not at_end
        up = self._lift.arrived(Code.LIFT_UP, lift_moves, time_ns)
        down = self._lift.arrived(Code.LIFT_DOWN, lift_moves, time_ns)
        closed = self._fingers.arrived(Code.CLOSE, pac.fingers_move, time_ns) and not pac.open
        flags = self._flags
        if flags is not None and flags.lift_up != flags.lift_down:
            up, down = (end and not lift_moves for end in (flags.lift_up, flags.lift_down))
        if flags is not None and flags.fingers_closed and not pac.fingers_move:
            closed = True
        self.switches = Switches(inner, outer, up, down, closed)

    def hear(self, flags: GripperFlags) -> None:
        """Take what a standard packet says, of a robot that sends GRIPPERpacs: which end the lift is at."""
        self._flags = flags

    def see_flags(self, flags: GripperFlags, time_ns: int) -> None:
        """Take what a standard packet says, of a robot that knows no GRIPPERpac."""
        up, down = (at_end and not flags.lift_moves for at_end in (flags.lift_up, flags.lift_down))
        closed = self._fingers.arrived(Code.CLOSE, flags.fingers_move, time_ns) or flags.fingers_closed
        inner, outer = self._obstructed(flags.inner_beam), self._obstructed(flags.outer_beam)
        self.switches = Switches(inner, outer, up, down, closed and not flags.fingers_move)

    def _obstructed(self, level: bool) -> bool:
        return level == self._obstructed_high
