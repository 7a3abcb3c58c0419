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
    """Of the continuous state while the action was in force."""
    alpha_change_rad: float
    """As above."""
    motion_periods: float
    """Sampling periods during which the state changed so: `periods` less the delay until the action was in force."""
    too_close: bool = False
    """The trial ended at the tilt limit: a sink inside the ranges; `next_cell` is then SINK."""
