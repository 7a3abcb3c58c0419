"""What does not change in a session: parameters, and what follows from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from components.pilot.ports import Params
from components.pilot.progress import Progress
from docking.cells import Grid
from docking.linear import Linear
from docking.task import Task

NS = 1_000_000_000
"""Nanoseconds in a second."""


@dataclass(frozen=True, slots=True)
class Rules:
    """Parameters with their grid, laws and seed."""

    params: Params
    seed: int
    grid: Grid
    teacher: Linear
    """The linear law, at the cell's centre or on the state."""
    servo: Linear
    """The law from the goal cell to the pick-up."""

    @staticmethod
    def of(params: Params, seed: int) -> Rules:
        """Rules of a session."""
        turn = params.task.turn_rate_radps
        return Rules(
            params,
            seed,
            Grid.of(params.task),
            Linear(params.k_beta_per_s, params.k_alpha_per_s, turn),
            Linear(params.servo_k_beta_per_s, params.servo_k_alpha_per_s, turn),
        )

    @property
    def task(self) -> Task:
        """The task in perceptual space."""
        return self.params.task

    def generator(self, progress: Progress) -> np.random.Generator:
        """Fresh generator for the next random choice of a trial, the same in a saved and loaded pilot."""
        return np.random.default_rng([self.seed, progress.phase, progress.number, progress.draws])
