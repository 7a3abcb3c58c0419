"""Advantage learning (Baird 1993; Gaskett 2002, which the paper discusses): one-step, without a model."""

from __future__ import annotations

from components.learner.methods.q_learning import QLearning


class Advantage(QLearning):
    """Differences between actions are stretched by 1 / scale, so that small ones are not lost in noise.

    A(s, a) moves towards V(s) + (r + V(s') - V(s)) / scale, V(s) = max over actions of A(s, a).

    The learning rate is scale / visits: for the best action scale and stretch cancel, and it moves as in Q-learning.
    With 1 / visits the first visit overshoots by 1 / scale, the cell before it again, and values grow from cell to cell
    (to 9900 on the printed plant, where no return exceeds 300).
    """

    def _step(self) -> float:
        return self.settings.advantage_scale

    def _target(self, value: float, backed_up: float, periods: float) -> float:
        del periods
        return value + (backed_up - value) / self.settings.advantage_scale
