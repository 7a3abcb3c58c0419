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
_USUAL = 2.0
"""A mean square error of so many times the expected one is nothing: it is the largest of three, and noise."""
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
    """A stretch whose mean square error is so many times what the model expects makes it forget the rest, and so do
    smaller errors that last."""
    fit: Fit | None = None
    """None until something was learned."""
    samples: int = 0
    """Frames learned from so far."""
    suspicion: float = 1.0
    """That the robot is another one: by how much the newest stretches together surprised more than is usual."""
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
        kept = float(np.exp(-len(measured) * self.period_s / self.memory_s))
        self.sums.fade(0.0 if self._has_changed(fresh) else kept)
        self.sums.include(fresh)
        self.samples += len(measured)
        self.fit = best_fit(self.sums, self.structures)
        return True

    def take_over(self, sums: Mapping[str, NDArray[Any]], samples: int, suspicion: float) -> None:
        """Go on with what was saved; the fit follows from the sums."""
        for name, own in self.sums.arrays().items():
            own[...] = sums[name]
        self.samples, self.suspicion = samples, suspicion
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

    def _has_changed(self, fresh: NormalEquations) -> bool:
        """Page's cumulative sum test (1954), its sum as a product: one large surprise, or smaller ones in a row."""
        if self.fit is None:
            return False
        self.suspicion = max(1.0, self.suspicion * surprise(self.fit, fresh) / _USUAL)
        changed = self.suspicion > self.surprise / _USUAL
        if changed:
            self.suspicion = 1.0
        return changed
