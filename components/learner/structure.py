"""What the rates of beta, alpha and ln d have to do with one another, as a linear map from fewer numbers.

A structure is a matrix T: theta [3 * 2 * functions] = T @ w [numbers]. Fewer numbers are learned from fewer samples.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from docking.rates import DEGREES, SIZES

Floats = NDArray[np.float64]
_BETA, _ALPHA, _D = range(3)
_FORWARDS, _TURN = range(2)
_MIRRORED = [0, 3, 5]
"""Of the six numbers: w_x per speed, w_y per turn rate, c per turn rate."""


@dataclass(frozen=True, eq=False)
class Structure:
    """One assumption about the rates."""

    name: str
    functions: str
    """Key of `docking.rates.FUNCTIONS`."""
    matrix: Floats
    """T, [3 * 2 * functions, numbers]."""
    spread: Floats
    """Prior standard deviation of each number, [numbers]; commands are counted in m/s and rad/s."""

    @cached_property
    def commands(self) -> Floats:
        """1 where a number belongs to speed (turn rate), else 0: [numbers, 2]."""
        used = np.abs(self.matrix.reshape(3, 2, -1, self.matrix.shape[1])).sum(axis=(0, 2)) > 0.0
        return np.asarray(used.T, dtype=np.float64)


@cache
def given() -> tuple[Structure, ...]:
    """A camera somewhere on a rigid robot that drives on the floor: six numbers, or three if left mirrors right.

    The camera's velocity (w_x, w_y), in camera heights per second, and the turn rate c are linear in the command:
    beta' = (w_x sin(alpha) - w_y cos(alpha)) / d, alpha' = beta' - c, d' / d = -(w_x cos(alpha) + w_y sin(alpha)) / d.
    So speed, turn rate, unequal wheels, and where the camera sits and looks are numbers to be learned.
    """
    size = SIZES["kinematic"]
    sine, cosine, one = range(size)
    shapes = (
        {(_BETA, sine): 1.0, (_ALPHA, sine): 1.0, (_D, cosine): -1.0},
        {(_BETA, cosine): -1.0, (_ALPHA, cosine): -1.0, (_D, sine): -1.0},
        {(_ALPHA, one): -1.0},
    )
    matrix = np.zeros((3, 2, size, 2 * len(shapes)))
    for command in (_FORWARDS, _TURN):
        for number, shape in enumerate(shapes):
            for (rate, function), factor in shape.items():
                matrix[rate, command, function, 2 * number + command] = factor
    whole = matrix.reshape(-1, 2 * len(shapes))
    return (
        Structure("given, mirrored", "kinematic", whole[:, _MIRRORED], np.full(len(_MIRRORED), 10.0)),
        Structure("given, not mirrored", "kinematic", whole, np.full(2 * len(shapes), 10.0)),
    )


@cache
def learned() -> tuple[Structure, ...]:
    """Any smooth rates; whether beta and alpha share a function, and whether left mirrors right, is to be found out."""
    return tuple(
        _polynomial(shared=shared, mirrored=mirrored) for shared in (True, False) for mirrored in (True, False)
    )


def _polynomial(*, shared: bool, mirrored: bool) -> Structure:
    size, columns, spread = SIZES["polynomial"], [], []
    for entries, deviation in _numbers(shared=shared, mirrored=mirrored):
        column = np.zeros((3, 2, size))
        for entry in entries:
            column[entry[:3]] = entry[3]
        columns.append(column.ravel())
        spread.append(deviation)
    name = f"{'shared' if shared else 'apart'}, {'mirrored' if mirrored else 'not mirrored'}"
    return Structure(name, "polynomial", np.stack(columns, axis=1), np.array(spread))


def _numbers(*, shared: bool, mirrored: bool) -> Iterator[tuple[tuple[tuple[int, int, int, float], ...], float]]:
    """(entries (rate, command, function, factor), prior deviation) of each number."""
    for command in (_FORWARDS, _TURN):
        for function, (in_alpha, in_log) in enumerate(DEGREES):
            deviation = 10.0 * 0.5 ** (in_alpha + in_log)
            for rate in (_BETA, _ALPHA, _D):
                if mirrored and (in_alpha + command + (rate != _D)) % 2 == 1:
                    continue
                if rate == _BETA and shared:
                    yield ((_BETA, command, function, 1.0), (_ALPHA, command, function, 1.0)), deviation
                elif rate != _ALPHA or not shared:
                    yield ((rate, command, function, 1.0),), deviation
        if shared and not (mirrored and command == _FORWARDS):
            yield ((_ALPHA, command, 0, -1.0),), 10.0


STRUCTURES: Mapping[str, tuple[Structure, ...]] = {"structure-given": given(), "structure-learned": learned()}
"""By the name of the method: what it chooses from."""
