"""What the robot's senses said in one frame, and the frames of one phase."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple


class Sample(NamedTuple):
    """One frame."""

    time_ns: int
    phase: str
    visible: bool
    u_px: float
    v_px: float
    """Of the object, from the image centre."""
    edge_v_px: float
    """Row of the table's edge below the object; NaN if it was not seen."""
    pan_rad: float
    tilt_rad: float
    """As the encoders read."""
    x_m: float
    y_m: float
    heading_rad: float
    """As the odometry reads."""
    inner: bool
    outer: bool
    """Beams, as they read."""
    lift_up: bool
    lift_down: bool
    closed: bool
    """Switches of the gripper."""


def of_phase(samples: Iterable[Sample], phase: str) -> list[Sample]:
    """The samples of one phase."""
    return [sample for sample in samples if sample.phase == phase]


def settled(samples: Iterable[Sample], phase: str, what: Callable[[Sample], float]) -> float:
    """Mean of a quantity over the last half of a phase, when all motion and every latency are over; NaN if unknown."""
    rows = of_phase(samples, phase)
    values = [value for sample in rows[len(rows) // 2 :] if sample.visible and math.isfinite(value := what(sample))]
    return sum(values) / len(values) if values else math.nan


def between(samples: Iterable[Sample], before: str, after: str, what: Callable[[Sample], float]) -> float:
    """By how much a quantity grew from one rest to another; NaN if unknown."""
    rows = list(samples)
    return settled(rows, after, what) - settled(rows, before, what)
