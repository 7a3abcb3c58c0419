"""Sums of a linear regression of motion on what could cause it, for each delay that a command may have.

Within a window of samples, percept = unknown begin + sum of theta integral(function * command) + white noise. So both
sides are counted from their mean over the window, and nothing is ever differentiated.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from docking.rates import FUNCTIONS, SIZES

Floats = NDArray[np.float64]

WINDOW = 40
"""Samples, 5 s: longer ones see more motion against the noise, shorter ones forget slip sooner."""
DELAYS = tuple(0.25 * quarter for quarter in range(17))
"""Sampling periods until a command is in force, 0 to 4."""


@dataclass(frozen=True)
class Stretch:
    """Frames in a row, one sampling period apart."""

    measured: Floats
    """[N, 3] beta, alpha, ln d."""
    smoothed: Floats
    """[N, 3], the same without noise."""
    commands: Floats
    """[N, 2] m/s and rad/s, executed from each frame on."""


@dataclass
class NormalEquations:
    """Of one set of functions."""

    functions: str
    period_s: float
    gram: Floats = field(init=False)
    """[delays, causes, causes], causes = 2 * functions."""
    moment: Floats = field(init=False)
    """[delays, 3, causes]"""
    square: Floats = field(init=False)
    """[delays, 3]"""
    count: Floats = field(init=False)
    """[delays] samples less one for each window."""

    def __post_init__(self) -> None:
        delays, causes = len(DELAYS), 2 * SIZES[self.functions]
        self.gram, self.moment = np.zeros((delays, causes, causes)), np.zeros((delays, 3, causes))
        self.square, self.count = np.zeros((delays, 3)), np.zeros(delays)

    def add(self, stretch: Stretch) -> None:
        """Count a stretch in."""
        for index, delay in enumerate(DELAYS):
            begin = int(np.ceil(max(DELAYS)))
            causes = self.causes(stretch, delay)[begin:]
            motion = stretch.measured[begin:]
            for first in range(0, len(motion), WINDOW):
                self._add_window(index, causes[first : first + WINDOW], motion[first : first + WINDOW])

    def fade(self, share: float) -> None:
        """Forget all but a share of what was counted."""
        for array in self.arrays().values():
            np.multiply(array, share, out=array)

    def include(self, other: NormalEquations) -> None:
        """Count in what another has counted."""
        for own, new in zip(self.arrays().values(), other.arrays().values(), strict=True):
            np.add(own, new, out=own)

    def arrays(self) -> dict[str, Floats]:
        """The sums, by name."""
        return {"gram": self.gram, "moment": self.moment, "square": self.square, "count": self.count}

    def causes(self, stretch: Stretch, delay: float) -> Floats:
        """Integrals of function times command since the first frame, `[N, causes]`, commands first."""
        middle = 0.5 * (stretch.smoothed[1:] + stretch.smoothed[:-1])
        known = FUNCTIONS[self.functions](middle[:, 1], np.exp(middle[:, 2]))
        forced = in_force(stretch.commands, delay)[:-1]
        products = (forced[:, :, None] * known[:, None, :]).reshape(len(known), -1) * self.period_s
        return np.concatenate([np.zeros((1, products.shape[1])), np.cumsum(products, axis=0)])

    def _add_window(self, index: int, causes: Floats, motion: Floats) -> None:
        if len(motion) < 4:
            return
        causes, motion = causes - causes.mean(axis=0), motion - motion.mean(axis=0)
        self.gram[index] += causes.T @ causes
        self.moment[index] += motion.T @ causes
        self.square[index] += (motion**2).sum(axis=0)
        self.count[index] += len(motion) - 1


def in_force(commands: Floats, delay: float) -> Floats:
    """Mean command in force from each frame to the next `[N, 2]`; before the first command it was the first."""
    whole = int(delay)
    share = delay - whole
    padded = np.concatenate([np.repeat(commands[:1], whole + 1, axis=0), commands])
    newer, older = padded[1 : len(commands) + 1], padded[: len(commands)]
    return np.asarray((1.0 - share) * newer + share * older)
