"""The likeliest delay, structure and rates for the sums of a regression: Bayesian, conjugate, in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from components.learner.normal_equations import DELAYS, NormalEquations
from components.learner.structure import Structure
from docking.angles import DEG
from docking.rates import RateModel

Floats = NDArray[np.float64]

_LEAST_VARIANCE = np.square((0.05 * DEG, 0.05 * DEG, 0.002))
"""No percept is better than this, and no structure is worth more numbers for a smaller error."""
_NO_SURPRISE = np.square((1.0 * DEG, 1.0 * DEG, 0.02))
"""Smaller errors are those of a motor that needs time to turn, not of another robot."""
_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class Fit:
    """A posterior over the numbers of one structure at one delay."""

    structure: Structure
    delay: float
    mean: Floats
    """[numbers]"""
    covariance: Floats
    """[numbers, numbers]"""
    variance: Floats
    """[3] of the measurements about the model: noise and what the structure can not say."""
    log_evidence: float

    @property
    def model(self) -> RateModel:
        """The mean as rates."""
        theta = (self.structure.matrix @ self.mean).reshape(3, 2, -1)
        return RateModel(self.structure.functions, theta, self.delay, tuple(np.sqrt(self.variance).tolist()))


def best_fit(sums: NormalEquations, structures: Sequence[Structure]) -> Fit:
    """The delay that explains most, then the structure of the largest evidence.

    Delays are judged under the second structure, which does not mirror: one that does would take a robot that drifts to
    one side for a late one.
    """
    by_delay = [fitted(sums, index, structures[1], None) for index in range(len(DELAYS))]
    index = int(np.argmin([np.log(fit.variance).sum() for fit in by_delay]))
    variance = fitted(sums, index, structures[-1], None).variance
    fits = [fitted(sums, index, structure, variance) for structure in structures]
    chosen = max(fits, key=lambda fit: fit.log_evidence)
    return fitted(sums, index, chosen.structure, None)


def fitted(sums: NormalEquations, index: int, structure: Structure, variance: Floats | None) -> Fit:
    """Posterior at one delay; a variance `[3]` that is not given is found from what remains."""
    rounds = _ROUNDS if variance is None else 1
    current = np.full(3, 1e-4) if variance is None else variance
    for _ in range(rounds):
        fit = _posterior(sums, index, structure, current)
        if variance is None:
            current = _remaining(sums, index, structure, fit.mean)
    return Fit(structure, fit.delay, fit.mean, fit.covariance, current, fit.log_evidence)


def surprise(fit: Fit, fresh: NormalEquations) -> float:
    """Mean square error of a fit on motion that it has not seen, over what it expects; the largest of the three rates.

    Expected are the measurements' variance and what the fit does not know yet.
    """
    index = DELAYS.index(fit.delay)
    if fresh.count[index] < 1.0:
        return 0.0
    unknown = [float(np.sum(gram * fit.covariance)) for gram, _ in _parts(fresh, index, fit.structure)]
    expected = np.maximum(fit.variance + np.array(unknown) / fresh.count[index], _NO_SURPRISE)
    return float((_remaining(fresh, index, fit.structure, fit.mean) / expected).max())


def _parts(sums: NormalEquations, index: int, structure: Structure) -> list[tuple[Floats, Floats]]:
    """Gram matrix and moment of the structure's numbers, for each rate."""
    maps = structure.matrix.reshape(3, -1, structure.matrix.shape[1])
    return [(T.T @ sums.gram[index] @ T, T.T @ sums.moment[index, j]) for j, T in enumerate(maps)]


def _posterior(sums: NormalEquations, index: int, structure: Structure, variance: Floats) -> Fit:
    parts = _parts(sums, index, structure)
    precision = np.diag(structure.spread**-2.0) + sum(gram / s for (gram, _), s in zip(parts, variance, strict=True))
    moment = sum(m / s for (_, m), s in zip(parts, variance, strict=True))
    covariance = np.linalg.inv(precision)
    mean = covariance @ moment
    count = sums.count[index]
    log_evidence = 0.5 * float(
        mean @ precision @ mean
        - (sums.square[index] / variance).sum()
        - count * np.log(variance).sum()
        - np.linalg.slogdet(precision)[1]
        - 2.0 * np.log(structure.spread).sum()
    )
    return Fit(structure, DELAYS[index], mean, covariance, variance, log_evidence)


def _remaining(sums: NormalEquations, index: int, structure: Structure, mean: Floats) -> Floats:
    parts = _parts(sums, index, structure)
    rest = [sums.square[index, j] - 2.0 * mean @ m + mean @ g @ mean for j, (g, m) in enumerate(parts)]
    return np.asarray(np.maximum(np.array(rest) / max(sums.count[index], 1.0), _LEAST_VARIANCE))
