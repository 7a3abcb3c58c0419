"""95 % intervals of means over seeds, by Student's t."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import stats


class Interval(NamedTuple):
    """A mean with its two-sided interval; the half width is nan for fewer than two values."""

    mean: float
    half_width: float
    seeds: int

    @property
    def low(self) -> float:
        """Lower bound."""
        return self.mean - self.half_width

    @property
    def high(self) -> float:
        """Upper bound."""
        return self.mean + self.half_width

    def __str__(self) -> str:
        """`53.2 +- 1.4`, or the mean alone where there is one value."""
        if math.isnan(self.mean):
            return "-"
        return f"{self.mean:.1f}" if math.isnan(self.half_width) else f"{self.mean:.1f} +- {self.half_width:.1f}"


def interval(values: Sequence[float | None], confidence: float = 0.95) -> Interval:
    """Mean of independent values and its Student t interval; None (nothing reached) is left out."""
    data = np.array([value for value in values if value is not None], dtype=float)
    if data.size == 0:
        return Interval(math.nan, math.nan, 0)
    if data.size == 1:
        return Interval(float(data[0]), math.nan, 1)
    spread = float(data.std(ddof=1)) / math.sqrt(data.size)
    return Interval(float(data.mean()), float(stats.t.ppf(0.5 + confidence / 2, data.size - 1)) * spread, data.size)


def paired(first: Sequence[float], second: Sequence[float], confidence: float = 0.95) -> Interval:
    """Interval of the mean of first - second, measured with the same seeds in the same order."""
    return interval([a - b for a, b in zip(first, second, strict=True)], confidence)
