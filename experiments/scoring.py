"""Docking times to rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.rows import Row
from experiments.starts import DISTANCES_M


@dataclass(frozen=True)
class Label:
    """The columns of a row that say what was measured."""

    experiment: str
    plant: str
    controller: str
    seed: int | None = None
    robot_minutes: float | None = None


def rows_of(
    label: Label, times_s: NDArray[np.float64], core_s: float, distances_m: Sequence[float] = DISTANCES_M
) -> list[Row]:
    """Rows of docking times: the mean over all starts first, then one per start distance.

    Args:
        label: what was measured.
        times_s: [distances * starts] in the order of `starts.protocol_starts`; inf where the goal was not reached.
        core_s: processor time of the whole measurement.
        distances_m: start distances.
    """
    speed = float(times_s[np.isfinite(times_s)].sum()) / core_s if core_s > 0.0 else None
    parts = zip(distances_m, np.split(times_s, len(distances_m)), strict=True)
    return [_row(label, times, distance, speed) for distance, times in [(None, times_s), *parts]]


def _row(label: Label, times_s: NDArray[np.float64], distance_m: float | None, speed: float | None) -> Row:
    reached = times_s[np.isfinite(times_s)]
    return Row(
        experiment=label.experiment,
        plant=label.plant,
        controller=label.controller,
        seed=label.seed,
        robot_minutes=label.robot_minutes,
        start_distance_m=distance_m,
        controllable_percent=100.0 * reached.size / times_s.size,
        docking_time_s=float(reached.mean()) if reached.size else None,
        robot_seconds_per_core_second=speed,
    )
