"""What the pilot makes of a percept."""

from __future__ import annotations

import math
from typing import NamedTuple

from docking.task import Task


class Sight(NamedTuple):
    """The object relative to the goal, from the axle (`docking.task.Seen`). Meaningless unless visible."""

    visible: bool
    beta_rad: float = 0.0
    alpha_rad: float = 0.0
    tilt_rad: float = 0.0
    """Not relative to the goal's."""
    too_close: bool = False
    """To the table's edge."""


UNSEEN = Sight(visible=False)
STEEPEST = 1e3
"""Slopes beyond this, 0.06 deg from upright, are no table edges."""


def sight_of(task: Task, visible: bool, slope: float, pan_rad: float, tilt_rad: float) -> Sight:
    """Read a percept; numbers that no head and no table edge can give count as not seen."""
    if not visible or not (abs(slope) < STEEPEST and abs(pan_rad) <= math.pi and 0.0 < tilt_rad < math.pi / 2):
        return UNSEEN
    return Sight(True, *task.seen(slope, pan_rad, tilt_rad))
