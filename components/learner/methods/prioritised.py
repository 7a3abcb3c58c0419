"""Prioritised sweeping, which the paper argues against (section IV): here so that the claim can be measured."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.backup import sweep_by_priority
from components.learner.methods.memory_sweep import MemorySweep
from components.learner.settings import Settings
from components.learner.transition import Transition
from docking.task import Task


class Prioritised(MemorySweep):
    """The same memory and filter; backs up where the values change most (Moore and Atkeson 1993)."""

    def __init__(self, task: Task, settings: Settings) -> None:
        super().__init__(task, settings)
        self.priority = np.zeros(self.q.size)
        self._reach = self.grid.beta_cells if settings.hold_periods else settings.adjoining_cells

    def plan(self) -> None:
        """At most `settings.backups` backups."""
        model = self.model
        sweep_by_priority(
            self.settings.backups,
            self.settings.mirror,
            self.q,
            self.v,
            model.successor,
            model.weight,
            model.degree,
            model.reward,
            self.rate,
            self.image,
            self.priority,
            self.grid.alpha_cells,
            self._reach,
        )

    def _learn(self, transition: Transition) -> bool:
        learned = super()._learn(transition)
        if learned:
            self.priority[transition.cell * len(self.actions) + transition.action] = np.inf
        return learned

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {**super()._arrays(), "priority": self.priority}
