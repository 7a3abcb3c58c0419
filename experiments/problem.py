"""A docking problem whose best solution can be computed: plant, actions, goal, delay, and how finely to compute."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from docking import actions
from docking.actions import ACTION_SETS, Actions
from docking.angles import DEG
from docking.levels import Limits
from docking.score import DOCKED_M, DOCKED_RAD
from docking.task import Task
from experiments.starts import D_MIN_M, DISTANCES_M, SAMPLING_S
from runtime.params import ConfigurationError

Floats = NDArray[np.float64]
PLANTS = ("geometric", "printed")
GOALS = ("cell", "dock")
GRIPPER_M = 0.28
"""Gripper ahead of the axle, of the simulated robot."""
_REVERSE_ROOM_M = 0.6
"""A reversing robot may go this far beyond the farthest start."""


def action_set(name: str, speed_mps: float, turn_rate_radps: float) -> Actions:
    """`docking.actions.action_set`, for a name that comes from outside.

    Raises:
        ConfigurationError: no such set.
    """
    if name not in ACTION_SETS:
        raise ConfigurationError(f"actions must be one of {', '.join(ACTION_SETS)}; got {name!r}")
    return actions.action_set(name, speed_mps, turn_rate_radps)


@dataclass(frozen=True)
class Problem:
    """What is to be reached, with what, and how finely it is computed."""

    plant: str = "geometric"
    """`geometric` is true; `printed` is the paper's."""
    actions: Actions = field(default_factory=lambda: Task().actions)
    goal: str = "cell"
    """`cell`: the goal cell, at any distance. `dock`: the gripper within 2 cm and 4 deg of its pose."""
    gripper_m: float = GRIPPER_M
    """Gripper ahead of the axle; d is measured from the axle."""
    delay_samples: int = 0
    """Sampling periods between a state and the action that answers it. The robot stands until the first."""
    task: Task = field(default_factory=Task)
    """Ranges and cells."""
    sampling_s: float = SAMPLING_S
    angle_step_rad: float = 0.5 * DEG
    """Spacing of the nodes in beta and alpha."""
    distance_step_m: float = 0.01
    """Spacing of the nodes in d."""
    backup_samples: int = 1
    """Sampling periods that one backup looks ahead. More for slow motion: short steps over wide nodes blur."""

    def __post_init__(self) -> None:
        for name, value, known in (("plant", self.plant, PLANTS), ("goal", self.goal, GOALS)):
            if value not in known:
                raise ConfigurationError(f"problem.{name} must be one of {', '.join(known)}; got {value!r}")
        numbers = (self.sampling_s, self.angle_step_rad, self.distance_step_m, self.gripper_m)
        if not all(0.0 < number < np.inf for number in numbers) or self.backup_samples < 1 or self.delay_samples < 0:
            raise ConfigurationError(f"problem's steps and lengths must be > 0 and finite; got {self}")
        if not self.actions or not np.isfinite(self.actions).all():
            raise ConfigurationError(f"problem.actions must be finite and not empty; got {self.actions}")

    @property
    def printed(self) -> bool:
        """Is it the paper's plant?"""
        return self.plant == "printed"

    @property
    def d_max_m(self) -> float:
        """Farther than this is the sink."""
        backwards = any(v < 0.0 for v, _ in self.actions)
        return max(DISTANCES_M) + (_REVERSE_ROOM_M if backwards else 0.0)

    @property
    def limits(self) -> Limits:
        """Goal and sink."""
        task = self.task
        return Limits(
            task.beta_range_rad / task.beta_cells,
            task.alpha_range_rad / task.alpha_cells,
            task.beta_range_rad,
            task.alpha_range_rad,
            D_MIN_M,
            self.d_max_m,
            self.gripper_m,
            self.goal == "dock",
            DOCKED_M,
            DOCKED_RAD,
        )

    @property
    def nodes(self) -> tuple[Floats, Floats, Floats]:
        """Nodes in beta, alpha (rad) and d (m): uniform over the ranges, one of them at beta = alpha = 0."""
        limits = self.limits
        beta, alpha = (
            np.linspace(-half, half, 2 * max(1, round(half / self.angle_step_rad)) + 1)
            for half in (limits.beta_range_rad, limits.alpha_range_rad)
        )
        steps = max(1, round((limits.d_max_m - limits.d_min_m) / self.distance_step_m))
        return beta, alpha, np.linspace(limits.d_min_m, limits.d_max_m, steps + 1)
