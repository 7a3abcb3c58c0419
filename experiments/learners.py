"""The controllers that the experiments compare, one list in one place: how each learns and how it is trained."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from components.learner.settings import Settings
from docking.linear import BEST_TUNED, HAND_TUNED, Linear
from docking.policy import PolicyTable
from docking.task import Task
from experiments.evaluation import World, policy_times
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import DISTANCES_M, Starts
from experiments.training import Checkpoint, Protocol

Gains = tuple[float, float]
"""k_beta and k_alpha of a linear law, 1/s."""

HAND: Mapping[str, Gains] = {"geometric": HAND_TUNED, "printed": (-1.5, 1.0)}
"""Without a search."""
TEACHER: Mapping[str, Gains] = {"geometric": (2.25, 1.25), "printed": (-1.5, 1.0)}
"""As good as the paper's own linear controller: 44.5 % on geometric, 45.2 % on printed."""
BEST: Mapping[str, Gains] = {"geometric": BEST_TUNED, "printed": (-3.25, 1.25)}
"""Of the grid below, measured over the protocol's starts."""
GRID_BETA, GRID_ALPHA = np.arange(0.5, 6.01, 0.25), np.arange(0.5, 4.01, 0.25)
"""The grid of gains: k_beta (negative on printed) and k_alpha, 1/s."""
EXPLORE = 0.2
"""Share of random actions while teacher and learner drive by turns, where nothing else is said."""


@dataclass(frozen=True)
class Learner:
    """How a controller comes to be."""

    settings: Settings
    cycle: tuple[str, ...] = ("random",)
    explore: float = 0.0
    explore_minutes: float = 0.0
    """As in `Protocol`."""
    teacher_where_unknown: bool = False
    gains: Gains | None = None
    """Of the teacher; None = TEACHER of the plant."""

    def protocol(self, plant: str, plant_noise: float = 0.0) -> Protocol:
        """How it is trained on a plant."""
        return Protocol(
            plant=plant,
            cycle=self.cycle,
            teacher=self.gains or TEACHER[plant],
            teacher_where_unknown=self.teacher_where_unknown,
            explore=self.explore,
            explore_minutes=self.explore_minutes,
            plant_noise=plant_noise,
        )

    def times_s(self, world: World, policy: PolicyTable, starts: Starts) -> NDArray[np.float64]:
        """Docking time of what was learned from each start, [starts] s; inf where the goal is not reached."""
        law = Linear(*(self.gains or TEACHER[world.plant]), world.task.turn_rate_radps)
        return policy_times(world, policy, starts, law if self.teacher_where_unknown else None)


EXITS, MOTION = Settings(model="exits"), Settings(model="displacement")
"""The two readings of the paper's filtered model."""
_TAUGHT = Learner(EXITS, ("lc", "greedy"), 0.1, teacher_where_unknown=True)

LEARNERS: Mapping[str, Learner] = {
    "RL": Learner(EXITS),
    "RL-LC": _TAUGHT,
    "RL-LC, LC and random trials": Learner(EXITS, ("lc", "random")),
    "RL without adjoining": Learner(replace(EXITS, hold_periods=1)),
    "prioritised sweeping": Learner(replace(EXITS, method="prioritised")),
    "Q-learning": Learner(replace(EXITS, method="q-learning")),
    "RL, motion model": Learner(MOTION),
    "RL-LC, motion model": replace(_TAUGHT, settings=MOTION, explore=0.8, explore_minutes=60.0),
}
"""By the name in the column `controller`. Exits: the model counts which neighbouring cell was entered; motion: it
averages the change of the continuous state. RL-LC: trials of the teacher alternate with trials of what was learned so
far, the teacher where nothing is known. In both a share of the actions is random: 10 % with exits; with motion 80 % at
first, falling to none at 60 minutes. Each is the best of those tried on other seeds (docs/results.md)."""


def law(gains: Gains, task: Task) -> Linear:
    """The linear controller of these gains."""
    return Linear(*gains, task.turn_rate_radps)


def learned_rows(
    label: Label,
    times_s: NDArray[np.float64],
    checkpoint: Checkpoint,
    distances_m: Sequence[float] = DISTANCES_M,
) -> list[Row]:
    """Rows of a learned controller; their speed is that of the training, simulated and learned."""
    speed = checkpoint.driven_s / checkpoint.core_s if checkpoint.core_s > 0.0 else None
    return [replace(row, robot_seconds_per_core_second=speed) for row in rows_of(label, times_s, 0.0, distances_m)]
