"""Percepts without their noise, as they come: an extended Kalman filter with the learned rates. Vectorised."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from docking.angles import DEG
from docking.rates import RateModel

Floats = NDArray[np.float64]

_SLIP = np.square((0.1 * DEG, 0.1 * DEG, 0.001))
"""Variance of beta, alpha and ln d that the model does not foresee in one sample."""
CLEAN = 0.003
"""Percepts with less noise, in rad and as a share of the distance, are taken as they are."""
_STEP = 1e-5
"""Of the differences that give the Jacobian."""
_FASTEST_RAD = 0.5
"""A percept that differs from what is expected by more, or by 50 % of the distance, begins anew."""


class PerceptFilter:
    """Of `[N]` robots at once. Follows each percept with the commands in force since the one before.

    Attributes:
        states: [N, 3] beta, alpha (rad), ln d; None before the first percept.
        sent: commands `[N, 2]`, the newest last; before the first one the robot stood.
    """

    def __init__(self, model: RateModel, count: int, period_s: float) -> None:
        self.model, self.period_s = model, period_s
        self._whole = int(model.delay_samples)
        self._share = model.delay_samples - self._whole
        self._noise = np.diag(np.maximum(np.square(model.noise), 1e-8))
        self._clean = max(model.noise) <= CLEAN
        self._covariance = np.repeat(self._noise[None], count, axis=0)
        self.states: Floats | None = None
        self.sent: list[Floats] = [np.zeros((count, 2))] * (self._whole + 2)

    def update(self, percepts: Floats) -> Floats:
        """States `[N, 3]` after percepts `[N, 3]` one sampling period after the ones before."""
        if self.states is None or self._clean:
            self.states = percepts.copy()
            return self.states
        expected, jacobian = self._expected(self.states)
        fresh = np.max(np.abs(percepts - expected), axis=1) > _FASTEST_RAD
        spread = jacobian @ self._covariance @ jacobian.transpose(0, 2, 1) + np.diag(_SLIP)
        gain = spread @ np.linalg.inv(spread + self._noise)
        updated = expected + np.einsum("nij,nj->ni", gain, percepts - expected)
        self.states = np.where(fresh[:, None], percepts, updated)
        self._covariance = np.where(fresh[:, None, None], self._noise, spread - gain @ spread)
        return self.states

    def send(self, commands: Floats) -> None:
        """Remember what was commanded at the newest percept."""
        self.sent = [*self.sent[1:], commands]

    def ahead(self, states: Floats) -> Floats:
        """States `[N, 3]` in which the next command will come into force."""
        return predicted(self.model, states, self.sent, self.period_s)

    def keep(self, kept: NDArray[np.bool_]) -> None:
        """Forget the other robots."""
        self.states = None if self.states is None else self.states[kept]
        self._covariance = self._covariance[kept]
        self.sent = [commands[kept] for commands in self.sent]

    def _expected(self, states: Floats) -> tuple[Floats, Floats]:
        """States one period later, and their Jacobian `[N, 3, 3]`: the identity but for what alpha and ln d change."""
        commands = (1.0 - self._share) * self.sent[-1 - self._whole] + self._share * self.sent[-2 - self._whole]
        rates = self.model.rates(states, commands)
        jacobian = np.tile(np.eye(3), (len(states), 1, 1))
        for column in (1, 2):
            aside = self.model.rates(states + _STEP * np.eye(3)[column], commands)
            jacobian[:, :, column] += (aside - rates) * (self.period_s / _STEP)
        return self._moved(states), jacobian

    def _moved(self, states: Floats) -> Floats:
        older, newer = self.sent[-2 - self._whole], self.sent[-1 - self._whole]
        if self._share > 0.0:
            states = self.model.moved(states, older, self._share * self.period_s)
        return self.model.moved(states, newer, (1.0 - self._share) * self.period_s)


def predicted(model: RateModel, states: Floats, sent: list[Floats], period_s: float) -> Floats:
    """States `[N, 3]` after the model's delay, driven by the commands `[N, 2]` that are on their way, newest last."""
    whole = int(model.delay_samples)
    spans = [model.delay_samples - whole] + [1.0] * whole
    for commands, span in zip(sent[len(sent) - whole - 1 :], spans, strict=True):
        if span > 0.0:
            states = model.moved(states, commands, span * period_s)
    return states
