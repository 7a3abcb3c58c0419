"""Memory-based non-prioritised sweeping, the paper's method (section IV)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.backup import sweep
from components.learner.methods.tabular import Tabular
from components.learner.model import DisplacementModel, ExitModel
from components.learner.settings import Settings
from components.learner.transition import Transition
from docking.task import Task


class MemorySweep(Tabular):
    """Each transition is filtered into the model; then every known (cell, action) is backed up N times."""

    def __init__(self, task: Task, settings: Settings) -> None:
        super().__init__(task, settings)
        kind = ExitModel if settings.model == "exits" else DisplacementModel
        self.model = kind(self.grid, len(self.actions), settings)
        self.rate = np.ones(self.q.size)

    def plan(self) -> None:
        """`settings.sweeps` full sweeps."""
        model = self.model
        sweep(
            self.settings.sweeps,
            self.settings.mirror,
            self.q,
            self.v,
            model.successor,
            model.weight,
            model.degree,
            model.reward,
            self.rate,
            self.image,
        )

    @property
    def known(self) -> NDArray[np.bool_]:
        """[cells * actions], tried at least once."""
        return self.model.degree > 0

    def _learn(self, transition: Transition) -> bool:
        if not self.model.observe(transition):
            return False
        pair = transition.cell * len(self.actions) + transition.action
        self._set_rate(pair)
        if self.settings.mirror:
            image = self._mirrored(transition)
            self.model.mirror(pair, image)
            self._set_rate(image)
        return True

    def _mirrored(self, transition: Transition) -> int:
        cell = self.grid.mirrored(transition.cell)
        return cell * len(self.actions) + int(self.image[transition.action])

    def _set_rate(self, pair: int) -> None:
        if self.settings.learning_rate == "inverse":
            self.rate[pair] = 1.0 / self.model.visits[pair]

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {**super()._arrays(), **self.model.arrays(), "rate": self.rate}

    def _restore(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        self.model.check(arrays)
        super()._restore(arrays)
