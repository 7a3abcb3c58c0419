"""The task's goal and limits in perceptual units, where distances are counted in camera heights."""

from __future__ import annotations

import math

from docking.levels import Limits
from docking.score import DOCKED_RAD
from docking.task import Task

DOCKED_SHARE = 0.02 / 0.28
"""Of the distance at the pick-up: how far off the gripper may be. 2 cm where it reaches 0.28 m."""
_AIM = 0.5
"""Share of the tolerances that is planned for: the edge of what counts is no place to aim at with a real motor."""
_REVERSE_ROOM = 1.3
"""A robot that can drive backwards may go so much farther than the farthest start."""


def limits_of(task: Task, room_rad: tuple[float, float], *, docking: bool) -> Limits:
    """What is goal and what is sink; no length is needed, since cot(tilt) is the distance in camera heights.

    The task's ranges are where the paper's cells end, not where a robot is lost: as far as `room_rad` (beta, alpha) a
    way may lead.
    """
    backwards = any(v < 0.0 for v, _ in task.actions)
    goal_d = 1.0 / math.tan(task.goal_tilt_rad)
    return Limits(
        beta_goal_rad=task.beta_range_rad / task.beta_cells,
        alpha_goal_rad=task.alpha_range_rad / task.alpha_cells,
        beta_range_rad=max(task.beta_range_rad, room_rad[0]),
        alpha_range_rad=max(task.alpha_range_rad, room_rad[1]),
        d_min_m=1.0 / math.tan(task.tilt_limit_rad),
        d_max_m=(_REVERSE_ROOM if backwards else 1.0) / math.tan(task.start_tilt_min_rad),
        gripper_m=goal_d,
        docking=docking,
        docked_m=_AIM * DOCKED_SHARE * goal_d,
        docked_rad=_AIM * DOCKED_RAD,
    )
