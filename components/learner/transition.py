"""One transition: an action held until the cell changed."""

from __future__ import annotations

from typing import NamedTuple


class Transition(NamedTuple):
    """What the learner learns from. Cells are indices of `docking.cells.Grid`, or SINK."""

    cell: int
    """In which the action began."""
    action: int
    """Index of the action that was executed."""
    next_cell: int
    """Entered; SINK outside the ranges; equal to `cell` only where actions are held for a fixed time."""
    periods: float
    """Sampling periods that it took (the paper's n)."""
    beta_change_rad: float
    """Of the continuous state, from the first sample in `cell` to the last of the transition."""
    alpha_change_rad: float
    """As above."""
    too_close: bool = False
    """The trial ended at the tilt limit: a sink inside the ranges; `next_cell` is then SINK."""
