"""Where a run begins: at a start, in the pick-up pose, or where a person puts a robot that is to be checked."""

from __future__ import annotations

import numpy as np

from components.simulator.params import Params
from docking.angles import DEG
from docking.starts import Start, start

BEGINNING_STREAM = 4
"""Tag of the generator of what a person does not place exactly."""


def first_start(params: Params, seed: int) -> Start:
    """Pose of a run's beginning.

    `goal`: in the pick-up pose. `facing`: two metres before the object, as well as a person places it.
    `fingertips`: the object 2 to 3.5 cm before both beams.
    """
    if params.begins == "goal":
        return Start(params.task.goal_heading_rad, 0.0, params.gripper_forward_m)
    if params.begins == "start":
        return start(params.starts, seed, 0, params.task)
    across, aside, along = np.random.default_rng([seed, 0, BEGINNING_STREAM]).random(3).tolist()
    if params.begins == "facing":
        return Start((2 * across - 1) * 20 * DEG, (2 * aside - 1) * 8 * DEG, 1.85 + 0.3 * along)
    tip_m = params.gripper_forward_m + 0.045 + 0.015 * along
    return Start((2 * across - 1) * 2 * DEG, (2 * aside - 1) * 1.5 * DEG, tip_m)
