"""What the robot has lived through, and the rates that it learned from that."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.normal_equations import NormalEquations, Stretch, in_force
from components.learner.regression import Fit, best_fit, surprise
from components.learner.smoother import smoothed
from components.learner.structure import Structure
from docking.rates import RateModel

Floats = NDArray[np.float64]

LEAST_SAMPLES = 16
"""A shorter stretch of frames teaches nothing."""
_ROUGH, _FINE = 1.0, 0.05
"""How fast the rest wanders that is smoothed: without a model and with one."""


@dataclass
class MotionMemory:
    """Smooths each stretch of frames as a whole, counts it in, and learns the rates again."""

    structures: Sequence[Structure]
    period_s: float
    memory_s: float
    """Time constant of forgetting."""
    surprise: float
    """A stretch whose mean square error is so many times what the model expects makes it forget the rest."""
    fit: Fit | None = None
    """None until something was learned."""
    samples: int = 0
    """Frames learned from so far."""
    sums: NormalEquations = field(init=False)

    def __post_init__(self) -> None:
        self.sums = NormalEquations(self.structures[0].functions, self.period_s)

    @property
    def model(self) -> RateModel | None:
        """The rates; None until something was learned."""
        return None if self.fit is None else self.fit.model

    def learn(self, measured: Floats, commands: Floats) -> bool:
        """Take in frames in a row: (beta, alpha, ln d) `[N, 3]` and commands `[N, 2]`. False if they are too few."""
        if len(measured) < LEAST_SAMPLES:
            return False
        fresh = NormalEquations(self.sums.functions, self.period_s)
        fresh.add(Stretch(measured, self.smooth(measured, commands), commands))
        changed = self.fit is not None and surprise(self.fit, fresh) > self.surprise
        self.sums.fade(0.0 if changed else float(np.exp(-len(measured) * self.period_s / self.memory_s)))
        self.sums.include(fresh)
        self.samples += len(measured)
        self.fit = best_fit(self.sums, self.structures)
        return True

    def take_over(self, sums: Mapping[str, NDArray[Any]], samples: int) -> None:
        """Go on with sums that were saved; the fit follows from them."""
        for name, own in self.sums.arrays().items():
            own[...] = sums[name]
        self.samples = samples
        self.fit = best_fit(self.sums, self.structures) if samples > 0 else None

    def smooth(self, measured: Floats, commands: Floats) -> Floats:
        """The frames without their noise, as far as the model knows them; without a model by themselves."""
        rough = smoothed(measured, np.zeros_like(measured), _ROUGH)
        model = self.model
        if model is None:
            return rough
        rates = model.rates(rough, in_force(commands, model.delay_samples))
        expected = np.concatenate([np.zeros((1, 3)), np.cumsum(rates[:-1] * self.period_s, axis=0)])
        return smoothed(measured, expected, _FINE)
