"""Plain one-step Q-learning: no memory, each transition is used once (paper, eq. 4; its "over 10 times longer")."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.methods.tabular import Tabular
from components.learner.settings import Settings
from components.learner.transition import Transition
from docking.cells import SINK
from docking.task import Task


class QLearning(Tabular):
    """Q moves towards reward plus the value of the cell entered, by one over the number of visits."""

    def __init__(self, task: Task, settings: Settings) -> None:
        super().__init__(task, settings)
        self.visits = np.zeros(self.q.size, dtype=np.int32)

    @property
    def known(self) -> NDArray[np.bool_]:
        """[cells * actions], tried at least once."""
        return self.visits > 0

    def _learn(self, transition: Transition) -> bool:
        reward = self.rewards.of(transition.next_cell, self.grid.goal, transition.periods)
        cell, action, entered = transition.cell, transition.action, transition.next_cell
        self._update(cell, action, entered, reward, transition.periods)
        if self.settings.mirror:
            image = int(self.image[action])
            self._update(self.grid.mirrored(cell), image, self.grid.mirrored(entered), reward, transition.periods)
        return True

    def _update(self, cell: int, action: int, entered: int, reward: float, periods: float) -> None:
        pair = cell * len(self.actions) + action
        self.visits[pair] += 1
        after = self.v[self.grid.count if entered == SINK else entered]
        target = self._target(float(self.v[cell]), reward + float(after), periods)
        self.q[pair] += self._step() * (target - self.q[pair]) / self.visits[pair]
        self.v[cell] = self._best(cell)

    def _step(self) -> float:
        """The first visit's learning rate."""
        return 1.0

    def _target(self, value: float, backed_up: float, periods: float) -> float:
        del value, periods
        return backed_up

    def _best(self, cell: int) -> float:
        actions = len(self.actions)
        return float(self.q[cell * actions : (cell + 1) * actions].max())

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {**super()._arrays(), "visits": self.visits}
