"""Advantage learning (Baird 1993; Gaskett 2002, which the paper discusses): one-step, without a model."""

from __future__ import annotations

from components.learner.methods.q_learning import QLearning


class Advantage(QLearning):
    """Differences between actions are stretched by 1 / scale, so that small ones are not lost in noise.

    A(s, a) moves towards V(s) + (r + V(s') - V(s)) / scale, V(s) = max over actions of A(s, a).
    """

    def _target(self, value: float, backed_up: float, periods: float) -> float:
        del periods
        return value + (backed_up - value) / self.settings.advantage_scale
