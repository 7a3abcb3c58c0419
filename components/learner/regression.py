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
Parts = list[tuple[Floats, Floats]]

_LEAST_VARIANCE = np.square((0.05 * DEG, 0.05 * DEG, 0.002))
"""No percept is better than this, and no structure is worth more numbers for a smaller error."""
_NO_SURPRISE = np.square((1.0 * DEG, 1.0 * DEG, 0.02))
"""Smaller errors are those of a motor that needs time to turn, not of another robot."""
_AS_ONE = 10.0
"""What a structure can not say errs alike in so many samples in a row: together they tell as much as one."""
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
    by_delay = [_variance(sums, index, structures[1]) for index in range(len(DELAYS))]
    index = int(np.argmin([np.log(variance).sum() for variance in by_delay]))
    variance = _variance(sums, index, structures[-1])
    fits = [fitted(sums, index, structure, variance) for structure in structures]
    chosen = max(fits, key=lambda fit: fit.log_evidence).structure
    return fitted(sums, index, chosen, _variance(sums, index, chosen))


def fitted(sums: NormalEquations, index: int, structure: Structure, variance: Floats) -> Fit:
    """Posterior at one delay and one variance `[3]` of the measurements."""
    precision, moment = _normal(_parts(sums, index, structure), structure, _AS_ONE * variance)
    covariance = np.asarray(np.linalg.inv(precision), dtype=np.float64)
    mean = covariance @ moment
    log_evidence = 0.5 * float(
        mean @ precision @ mean
        - (sums.square[index] / (_AS_ONE * variance)).sum()
        - sums.count[index] / _AS_ONE * np.log(variance).sum()
        - np.linalg.slogdet(precision)[1]
        - 2.0 * np.log(structure.spread).sum()
    )
    return Fit(structure, DELAYS[index], mean, covariance, variance, log_evidence)


def surprise(fit: Fit, fresh: NormalEquations) -> float:
    """Mean square error of a fit on motion that it has not seen, over what it expects; the largest of the three rates.

    Expected are the measurements' variance and what the fit does not know yet.
    """
    index = DELAYS.index(fit.delay)
    if fresh.count[index] < 1.0:
        return 0.0
    unknown = [float(np.sum(gram * fit.covariance)) for gram, _ in _parts(fresh, index, fit.structure)]
    expected = np.maximum(fit.variance + np.array(unknown) / fresh.count[index], _NO_SURPRISE)
    return float((_remaining(fresh, index, _parts(fresh, index, fit.structure), fit.mean) / expected).max())


def _variance(sums: NormalEquations, index: int, structure: Structure) -> Floats:
    """Of the measurements `[3]`, found from what a structure leaves at one delay."""
    variance, parts = np.full(3, 1e-4), _parts(sums, index, structure)
    for _ in range(_ROUNDS):
        mean = np.asarray(np.linalg.solve(*_normal(parts, structure, variance)), dtype=np.float64)
        variance = _remaining(sums, index, parts, mean)
    return variance


def _parts(sums: NormalEquations, index: int, structure: Structure) -> Parts:
    """Gram matrix and moment of the structure's numbers, for each rate."""
    maps = structure.matrix.reshape(3, -1, structure.matrix.shape[1])
    return [(T.T @ sums.gram[index] @ T, T.T @ sums.moment[index, j]) for j, T in enumerate(maps)]


def _normal(parts: Parts, structure: Structure, variance: Floats) -> tuple[Floats, Floats]:
    """Precision and moment of the posterior."""
    precision: Floats = np.diag(structure.spread**-2.0)
    moment: Floats = np.zeros(len(precision))
    for (gram, m), s in zip(parts, variance, strict=True):
        precision, moment = precision + gram / s, moment + m / s
    return precision, moment


def _remaining(sums: NormalEquations, index: int, parts: Parts, mean: Floats) -> Floats:
    rest = [sums.square[index, j] - 2.0 * mean @ m + mean @ g @ mean for j, (g, m) in enumerate(parts)]
    return np.asarray(np.maximum(np.array(rest) / max(sums.count[index], 1.0), _LEAST_VARIANCE))
