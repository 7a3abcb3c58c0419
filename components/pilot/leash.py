"""How fast a robot may approach the table whose own watchdog is slow."""

from __future__ import annotations

import math

from components.pilot.progress import Wish
from components.pilot.rules import Rules
from components.pilot.sight import Sight


def leashed(rules: Rules, wish: Wish, sight: Sight, watchdog_s: float) -> Wish:
    """The wish, slowed down so that speed times watchdog stays below the free way; its path stays the same.

    Args:
        rules: of the session.
        wish: of this frame.
        sight: of this frame; unseen, nobody drives forwards anyway.
        watchdog_s: of the robot; 0 = unknown.
    """
    if not (wish.v_mps > 0.0 and watchdog_s > 0.0 and sight.visible):
        return wish
    share = min(1.0, max(0.0, free_way_m(rules, sight)) / (watchdog_s * wish.v_mps))
    return wish._replace(v_mps=share * wish.v_mps, omega_radps=share * wish.omega_radps)


def free_way_m(rules: Rules, sight: Sight) -> float:
    """From the gripper to the table, square to its edge, reckoned from the tilt."""
    task, params = rules.task, rules.params
    heights = math.cos(sight.beta_rad + task.goal_beta_rad) / math.tan(sight.tilt_rad)
    return params.camera_height_m * (heights - 1.0 / math.tan(task.tilt_limit_rad)) + params.table_room_m
