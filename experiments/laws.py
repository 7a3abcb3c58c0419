"""Controllers of many states at once: the linear law, a table over cells, the docking law."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from docking.cells import Grid
from docking.linear import Linear
from docking.task import Task
from experiments.controller import Controller
from experiments.docking_law import DockingLaw
from experiments.problem import Floats


def linear(law: Linear, speed_mps: float) -> Controller:
    """The continuous linear law, at one speed."""

    def act(beta: Floats, alpha: Floats, d: Floats) -> tuple[Floats, Floats]:
        wanted = law.k_beta_per_s * beta + law.k_alpha_per_s * alpha
        return np.full_like(d, speed_mps), np.clip(wanted, -law.turn_rate_radps, law.turn_rate_radps)

    return act


def tabled(actions: NDArray[np.int8], task: Task) -> Controller:
    """An action index for each cell of the task, all known; outside the ranges the robot stands."""
    grid, moves = Grid.of(task), np.array([*task.actions, (0.0, 0.0)])
    table = np.append(actions, len(task.actions))

    def act(beta: Floats, alpha: Floats, _d: Floats) -> tuple[Floats, Floats]:
        cells = np.array([grid.cell(b, a) for b, a in zip(beta.tolist(), alpha.tolist(), strict=True)], dtype=np.int64)
        chosen = moves[table[cells]]
        return chosen[:, 0], chosen[:, 1]

    return act


def docking(law: DockingLaw, ahead_m: float) -> Controller:
    """The docking law, told the true pose, towards the pose `ahead_m` before the object, facing it."""

    def act(beta: Floats, alpha: Floats, d: Floats) -> tuple[Floats, Floats]:
        return law.toward((-ahead_m, 0.0, 0.0), (-d * np.cos(beta), -d * np.sin(beta), beta - alpha))

    return act
