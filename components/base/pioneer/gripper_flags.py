"""The gripper by the standard packet alone, for firmware that knows no GRIPPERpac. Pure.

Pioneer Gripper Manual, table 4: a byte of its own. Which of two bytes it is, sources disagree; ARIA and Player take the
second. The break beams are not in it: with a gripper at the user's inputs they are two of these, as ARIA reads them.
"""

from __future__ import annotations

from typing import NamedTuple

from components.base.pioneer.sip import Sip

_OPEN, _CLOSED, _FINGERS_MOVE, _, _UP, _DOWN, _LIFT_MOVES, _ = (1 << bit for bit in range(8))
_OUTER, _INNER = 1 << 2, 1 << 3


class GripperFlags(NamedTuple):
    """What the packet says; the beams as they are read."""

    fingers_closed: bool
    fingers_move: bool
    lift_up: bool
    lift_down: bool
    lift_moves: bool
    outer_beam: bool
    """Level of the line."""
    inner_beam: bool


def flags_of(sip: Sip) -> GripperFlags | None:
    """From a standard packet; None if it is too short for it. Of two opposites that are both true neither is."""
    state, inputs = sip.gripper, sip.digital_in
    if state is None or inputs is None:
        return None
    closed, up, down = bool(state & _CLOSED), bool(state & _UP), bool(state & _DOWN)
    return GripperFlags(
        closed and not state & _OPEN,
        bool(state & _FINGERS_MOVE),
        up and not down,
        down and not up,
        bool(state & _LIFT_MOVES),
        bool(inputs & _OUTER),
        bool(inputs & _INNER),
    )
