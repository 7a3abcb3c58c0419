"""What the robot has lived through, and the rates that it learned from that."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
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
_KEPT_FITS = 32
"""Newest of one robot with others."""
_ROUGH, _FINE = 1.0, 0.05
"""How fast the rest wanders that is smoothed: without a model and with one."""

_PLAIN: Mapping[str, Callable[[Any], Any]] = {"samples": int, "suspicion": float}


@dataclass(eq=False)
class MotionMemory:
    """Smooths each stretch of frames as a whole, counts it in, and learns the rates again."""

    structures: Sequence[Structure]
    period_s: float
    memory_s: float
    """Time constant of forgetting."""
    surprise: float
    """A stretch whose mean square error is so many times what the model expects makes it forget the rest, and so do
    smaller errors that last."""
    alike: list[MotionMemory] = field(default_factory=list, repr=False)
    """Of robots that were built alike, this one's too: each adds itself."""
    samples: int = 0
    """Frames learned from so far."""
    suspicion: float = 1.0
    """That the robot is another one: by how much the newest stretches together surprised more than is usual."""
    sums: NormalEquations = field(init=False)
    _fits: dict[tuple[int, ...], Fit] = field(default_factory=dict, repr=False)
    """To what this robot, and others together with it, had seen, by the frames that each had learned from."""

    def __post_init__(self) -> None:
        self.sums = NormalEquations(self.structures[0].functions, self.period_s)
        self.alike.append(self)

    @property
    def fit(self) -> Fit | None:
        """To what this robot and those alike have seen; None until this one has learned something."""
        if self.samples == 0:
            return None
        others = [one for one in self.alike if one is not self and one.samples and self._is_like(one)]
        return self._fitted(others)

    def _is_like(self, other: MotionMemory) -> bool:
        """Whether it is likelier that both move by the same rates, each at its own scale, than each by its own."""
        return self._fitted([other]).log_evidence > self._fitted([]).log_evidence + other._fitted([]).log_evidence

    def _fitted(self, others: Sequence[MotionMemory]) -> Fit:
        key = tuple(one.samples if one is self or one in others else 0 for one in self.alike)
        if key not in self._fits:
            if len(self._fits) >= _KEPT_FITS:
                self._fits.clear()
            self._fits[key] = best_fit([self.sums, *(one.sums for one in others)], self.structures)
        return self._fits[key]

    @property
    def model(self) -> RateModel | None:
        """The rates; None until something was learned."""
        fit = self.fit
        return None if fit is None else fit.model

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
        self._fits.clear()
        return True

    def to_plain(self) -> dict[str, Any]:
        """Everything but the sums; the fit follows from those."""
        return {name: getattr(self, name) for name in _PLAIN}

    def take_over(self, sums: Mapping[str, NDArray[Any]], plain: Mapping[str, Any]) -> None:
        """Go on with what was saved.

        Raises:
            KeyError, TypeError, ValueError: it is nothing of the kind.
        """
        taken = {name: kind(plain[name]) for name, kind in _PLAIN.items()}
        for name, own in self.sums.arrays().items():
            own[...] = sums[name]
        for name, value in taken.items():
            setattr(self, name, value)
        self._fits.clear()

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
        fit = self.fit
        if fit is None:
            return False
        self.suspicion = max(1.0, self.suspicion * surprise(fit, fresh) / _USUAL)
        changed = self.suspicion > self.surprise / _USUAL
        if changed:
            self.suspicion = 1.0
        return changed
