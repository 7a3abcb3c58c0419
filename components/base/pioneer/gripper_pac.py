"""GRIPPERpac: the gripper's switches and break beams. Pure. Pioneer 2 Operations Manual."""

from __future__ import annotations

from typing import NamedTuple

TYPE = 0xE0
NO_GRIPPER = 0
"""Kind."""
_OPEN, _LIFT, _OUTER, _INNER, _LEFT, _RIGHT, _LIFT_MOVES, _FINGERS_MOVE = (1 << bit for bit in range(8))


class GripperPac(NamedTuple):
    """Bits as the manual's active-low switches mean them; the beams as they are read."""

    kind: int
    """0 = there is no gripper."""
    open: bool
    """Fully."""
    lift_at_end: bool
    """At the top or at the bottom: one switch for both."""
    outer_beam: bool
    """Level of the line. Whether high or low means obstructed, sources disagree."""
    inner_beam: bool
    grasping: bool
    """A paddle is pressed."""
    lift_moves: bool
    fingers_move: bool


def gripper_of(payload: bytes) -> GripperPac | None:
    """The packet; None if it is another or too short."""
    if payload[:1] != bytes((TYPE,)) or len(payload) < 3:
        return None
    state = payload[2]
    return GripperPac(
        kind=payload[1],
        open=not state & _OPEN,
        lift_at_end=not state & _LIFT,
        outer_beam=bool(state & _OUTER),
        inner_beam=bool(state & _INNER),
        grasping=not (state & _LEFT and state & _RIGHT),
        lift_moves=bool(state & _LIFT_MOVES),
        fingers_move=bool(state & _FINGERS_MOVE),
    )
