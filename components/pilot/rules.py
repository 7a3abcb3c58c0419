"""What does not change in a session: parameters, and what follows from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from components.pilot.ports import Params
from components.pilot.progress import Phase, Progress
from docking.cells import Grid
from docking.linear import Linear
from docking.policy import PolicyTable
from docking.task import Task

_ORDER_STREAM, _START_STREAM = 7, 8
"""Tags of the generators of a comparison's order within pairs, and of its starts."""
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
    rival: PolicyTable | None = None
    """The policy that the pilot's own is compared with."""

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
            PolicyTable.from_bytes(params.rival_policy) if params.rival_policy else None,
        )

    @property
    def task(self) -> Task:
        """The task in perceptual space."""
        return self.params.task

    @property
    def compares(self) -> bool:
        """Whether evaluation alternates between two policies."""
        return self.params.rival_controller != ""

    def is_rivals(self, progress: Progress) -> bool:
        """Whether the rival drives this trial: one of each pair of trials, first or second as the seed has it."""
        if not self.compares or progress.phase != Phase.EVALUATE:
            return False
        first = int(np.random.default_rng([self.seed, progress.number // 2, _ORDER_STREAM]).integers(2))
        return progress.number % 2 == first

    def start_of(self, number: int) -> int:
        """Number of an evaluation trial's start; the trials of a pair have the same."""
        return self.params.first_start + (number // 2 if self.compares else number)

    def start_generator(self, progress: Progress) -> np.random.Generator:
        """As `generator`, for where a reverse shall end: in a comparison the trials of a pair begin alike."""
        if not (self.compares and progress.phase == Phase.EVALUATE):
            return self.generator(progress)
        return np.random.default_rng([self.seed, _START_STREAM, (progress.number + 1) // 2, progress.draws])

    def generator(self, progress: Progress) -> np.random.Generator:
        """Fresh generator for the next random choice of a trial, the same in a saved and loaded pilot."""
        return np.random.default_rng([self.seed, progress.phase, progress.number, progress.draws])
