"""Seeded start poses: the same number gives the same start to the simulator and to every experiment."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from docking.angles import DEG
from docking.task import Task

KINDS = ("demo", "full")
"""`demo`: |beta| <= 45 deg, |alpha| <= 30 deg, 1.5-2 m, where one speed can dock from 97 % and more.
`full`: all of the task's ranges, 1-2 m."""


class Start(NamedTuple):
    """Where the object is seen from, as `docking.plant.pose` takes it."""

    beta_rad: float
    alpha_rad: float
    d_axle_m: float


class Span(NamedTuple):
    """Starts are uniform over +- beta, +- alpha and between the two distances."""

    beta_rad: float
    alpha_rad: float
    nearest_m: float
    farthest_m: float


def span(kind: str, task: Task) -> Span:
    """Ranges of the starts of a kind.

    Raises:
        ValueError: `kind` is not one of `KINDS`.
    """
    if kind == "demo":
        return Span(45 * DEG, 30 * DEG, 1.5, 2.0)
    if kind == "full":
        return Span(task.beta_range_rad, task.alpha_range_rad, 1.0, 2.0)
    raise ValueError(f"start kind must be one of {', '.join(KINDS)}; got {kind!r}")


def start(kind: str, seed: int, number: int, task: Task) -> Start:
    """Start `number` (from 0) of the endless list that `kind` and `seed` name; uniform and independent."""
    ranges = span(kind, task)
    beta, alpha, far = np.random.default_rng([seed, number]).random(3)
    return Start(
        float((2.0 * beta - 1.0) * ranges.beta_rad),
        float((2.0 * alpha - 1.0) * ranges.alpha_rad),
        float(ranges.nearest_m + far * (ranges.farthest_m - ranges.nearest_m)),
    )
