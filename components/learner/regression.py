"""The likeliest delay, structure and rates for the sums of a regression: Bayesian, conjugate, in closed form.

Robots that are built alike move by the same rates, each at its own scale of speed and of turn rate: a factor of all
that a command's speed (turn rate) does. Rates and scales are found in turn, each with the other known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

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
_AS_ONE = 10.0
"""What a structure can not say errs alike in so many samples in a row: together they tell as much as one."""
ALIKE = 0.06
"""Prior standard deviation of a robot's scales about those of all: they differ by up to a tenth."""
_ROUNDS = 3
_FIRST_ROUNDS = 8
"""From scales of 1."""


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


class Sums(NamedTuple):
    """Of a structure's numbers at one delay, for each of the three rates."""

    gram: Floats
    """[3, numbers, numbers]"""
    moment: Floats
    """[3, numbers]"""
    square: Floats
    """[3]"""
    samples: float
    """Less one for each window."""

    def scaled(self, factors: Floats) -> Sums:
        """As seen by a robot whose numbers are these factors `[numbers]` smaller."""
        return self._replace(gram=self.gram * np.outer(factors, factors), moment=self.moment * factors)


class Scale(NamedTuple):
    """A robot's speed and turn rate, as shares of those that all have in common: a normal distribution."""

    mean: Floats
    """[2]"""
    covariance: Floats
    """[2, 2]"""


_ONE = Scale(np.ones(2), np.zeros((2, 2)))


class Common(NamedTuple):
    """What is found of all robots together."""

    whole: Sums
    """Of all, as if one robot had seen it all."""
    scales: Sequence[Scale]
    variance: Floats
    """[3]"""


def best_fit(robots: Sequence[NormalEquations], structures: Sequence[Structure]) -> Fit:
    """The delay that explains most, then the structure of the largest evidence: what is known of the first robot.

    Delays are judged under the second structure, which does not mirror: one that does would take a robot that drifts to
    one side for a late one.
    """
    index, scales = _likeliest_delay(robots, structures[1])
    structure = _likeliest_structure(robots, index, structures, scales)
    common = _in_common(robots, index, structure, scales)
    fit = _fitted(common.whole, index, structure, common.variance)
    return fit if len(robots) == 1 else _own(fit, common.scales)


def _likeliest_delay(robots: Sequence[NormalEquations], structure: Structure) -> tuple[int, Sequence[Scale]]:
    """Its index, and the scales there. Those of one delay are where the search at the next begins."""
    commons = [_in_common(robots, 0, structure, [_ONE] * len(robots), first=True)]
    for index in range(1, len(DELAYS)):
        commons.append(_in_common(robots, index, structure, commons[-1].scales))
    index = int(np.argmin([np.log(common.variance).sum() for common in commons]))
    return index, commons[index].scales


def _likeliest_structure(
    robots: Sequence[NormalEquations], index: int, structures: Sequence[Structure], scales: Sequence[Scale]
) -> Structure:
    """All judged by the errors that the richest leaves."""
    commons = [_in_common(robots, index, structure, scales) for structure in structures]
    pairs = zip(commons, structures, strict=True)
    fits = [_fitted(common.whole, index, structure, commons[-1].variance) for common, structure in pairs]
    return max(fits, key=lambda fit: fit.log_evidence).structure


def surprise(fit: Fit, fresh: NormalEquations) -> float:
    """Mean square error of a fit on motion that it has not seen, over what it expects; the largest of the three rates.

    Expected are the measurements' variance and what the fit does not know yet.
    """
    sums = _reduced(fresh, DELAYS.index(fit.delay), fit.structure)
    if sums.samples < 1.0:
        return 0.0
    unknown = [float(np.sum(gram * fit.covariance)) for gram in sums.gram]
    expected = np.maximum(fit.variance + np.array(unknown) / sums.samples, _NO_SURPRISE)
    return float((_remaining(sums, fit.mean) / expected).max())


def _in_common(
    robots: Sequence[NormalEquations], index: int, structure: Structure, scales: Sequence[Scale], *, first: bool = False
) -> Common:
    """Scales, from those that were found before, and the variance of what a structure leaves at one delay."""
    seen = [_reduced(sums, index, structure) for sums in robots]
    common = Common(_as_one(seen, scales, structure), scales, np.full(3, 1e-4))
    for _ in range(_FIRST_ROUNDS if first and len(seen) > 1 else _ROUNDS):
        mean = np.asarray(np.linalg.solve(*_normal(common.whole, structure, common.variance)), dtype=np.float64)
        variance = _remaining(common.whole, mean)
        if len(seen) > 1:
            scales = [_scale(sums, structure, mean, variance) for sums in seen]
        common = Common(_as_one(seen, scales, structure), scales, variance)
    return common


def _scale(sums: Sums, structure: Structure, mean: Floats, variance: Floats) -> Scale:
    """Posterior of one robot's, with the numbers known that all have in common."""
    two = mean[:, None] * structure.commands
    precision = np.eye(2) * ALIKE**-2.0 + two.T @ (sums.gram / variance[:, None, None]).sum(axis=0) @ two
    moment = np.full(2, ALIKE**-2.0) + (sums.moment / variance[:, None]).sum(axis=0) @ two
    covariance = np.asarray(np.linalg.inv(precision), dtype=np.float64)
    return Scale(covariance @ moment, covariance)


def _as_one(seen: Sequence[Sums], scales: Sequence[Scale], structure: Structure) -> Sums:
    """What robots of these scales have seen, as if one had seen it all whose scales are 1."""
    if len(seen) == 1:
        return seen[0]
    scaled = [sums.scaled(structure.commands @ scale.mean) for sums, scale in zip(seen, scales, strict=True)]
    return Sums(*(np.sum(column, axis=0) for column in zip(*scaled, strict=True)))


def _own(common: Fit, scales: Sequence[Scale]) -> Fit:
    """The rates of all at the first robot's scale, and what is not known of either."""
    scale = scales[0]
    factors = common.structure.commands @ scale.mean
    two = common.mean[:, None] * common.structure.commands
    covariance = common.covariance * np.outer(factors, factors) + two @ scale.covariance @ two.T
    log_evidence = common.log_evidence + scales_evidence(scales)
    return replace(common, mean=common.mean * factors, covariance=covariance, log_evidence=log_evidence)


def scales_evidence(scales: Sequence[Scale]) -> float:
    """What the scales of several robots add to the logarithm: how unlikely they were, and how well they are known."""
    off = sum(float(np.sum((scale.mean - 1.0) ** 2)) for scale in scales) / ALIKE**2
    known = sum(float(np.linalg.slogdet(scale.covariance / ALIKE**2)[1]) for scale in scales)
    return 0.5 * (known - off)


def _fitted(sums: Sums, index: int, structure: Structure, variance: Floats) -> Fit:
    """Posterior at one delay and one variance of the measurements."""
    precision, moment = _normal(sums, structure, _AS_ONE * variance)
    covariance = np.asarray(np.linalg.inv(precision), dtype=np.float64)
    mean = covariance @ moment
    log_evidence = 0.5 * float(
        mean @ precision @ mean
        - (sums.square / (_AS_ONE * variance)).sum()
        - sums.samples / _AS_ONE * np.log(variance).sum()
        - np.linalg.slogdet(precision)[1]
        - 2.0 * np.log(structure.spread).sum()
    )
    return Fit(structure, DELAYS[index], mean, covariance, variance, log_evidence)


def _reduced(sums: NormalEquations, index: int, structure: Structure) -> Sums:
    maps = structure.matrix.reshape(3, -1, structure.matrix.shape[1])
    gram = np.stack([T.T @ sums.gram[index] @ T for T in maps])
    moment = np.stack([T.T @ sums.moment[index, j] for j, T in enumerate(maps)])
    return Sums(gram, moment, sums.square[index], float(sums.count[index]))


def _normal(sums: Sums, structure: Structure, variance: Floats) -> tuple[Floats, Floats]:
    """Precision and moment of the posterior."""
    precision: Floats = np.diag(structure.spread**-2.0)
    moment: Floats = np.zeros(len(precision))
    for gram, m, s in zip(sums.gram, sums.moment, variance, strict=True):
        precision, moment = precision + gram / s, moment + m / s
    return precision, moment


def _remaining(sums: Sums, mean: Floats) -> Floats:
    of_all = zip(sums.square, sums.gram, sums.moment, strict=True)
    rest = [square - 2.0 * mean @ m + mean @ gram @ mean for square, gram, m in of_all]
    return np.asarray(np.maximum(np.array(rest) / max(sums.samples, 1.0), _LEAST_VARIANCE))
