"""The goal, shown: robot and object stand in the pick-up pose, and what is perceived there becomes the goal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np

from docking.angles import DEG
from docking.task import Task
from runtime.params import build

FEWEST_FRAMES = 16
"""Two seconds."""
LEAST_SEEN = 0.8
"""Share of the frames in which object and edge must be seen."""


class Percept(NamedTuple):
    """One frame, as `berth.Percept` has it."""

    visible: bool
    slope: float
    pan_rad: float
    tilt_rad: float


class Point(NamedTuple):
    """In perceptual space."""

    slope: float
    pan_rad: float
    tilt_rad: float


LARGEST_SPREAD = Point(0.03, 0.5 * DEG, 0.5 * DEG)
"""Standard deviations of a robot at rest are a tenth of this in simulation; one that creeps 3 cm exceeds it. 0.03 of
slope are 2 deg of beta at the pick-up."""


class NotShownError(ValueError):
    """What was seen is no goal; the text says why."""


@dataclass(frozen=True, slots=True)
class Showing:
    """Mean and spread over the frames in which object and edge were seen."""

    mean: Point
    spread: Point
    """Standard deviations."""
    seen: int
    frames: int

    @staticmethod
    def of(percepts: Sequence[Percept]) -> Showing:
        """Of consecutive frames.

        Raises:
            NotShownError: too few frames, the object not seen in them, or the robot or the object moved.
        """
        points = [Point(*percept[1:]) for percept in percepts if percept.visible and all(map(math.isfinite, percept))]
        if len(percepts) < FEWEST_FRAMES:
            raise NotShownError(f"there must be at least {FEWEST_FRAMES} frames; got {len(percepts)}")
        if len(points) < LEAST_SEEN * len(percepts):
            raise NotShownError(
                f"object and table edge must be seen in {100 * LEAST_SEEN:g} % of the frames; "
                f"they are in {len(points)} of {len(percepts)}"
            )
        mean, spread = (Point(*column.tolist()) for column in (np.mean(points, axis=0), np.std(points, axis=0)))
        showing = Showing(mean, spread, len(points), len(percepts))
        showing.check()
        return showing

    def check(self) -> None:
        """Refuse a robot or an object that moved.

        Raises:
            NotShownError: the spread is too large.
        """
        for name, spread, largest in zip(Point._fields, self.spread, LARGEST_SPREAD, strict=True):
            if spread > largest:
                raise NotShownError(
                    f"{name} must not spread by more than {largest:.3g}, so that robot and object are at rest; "
                    f"it spreads by {spread:.3g} over {self.seen} frames"
                )

    def task(self, base: Task, heading_rad: float | None = None) -> Task:
        """A task with this goal.

        The tilts that stand for distances keep their ratio to the distance of the goal, so that a camera at another
        height, or a longer gripper, needs no length.

        Args:
            base: the other fields, and the tilts to go by.
            heading_rad: of the robot against the table's normal in the pick-up pose; None = as in `base`.

        Raises:
            ConfigurationError: the goal is none that a task can have.
        """
        goal = {f"goal_{name}": value for name, value in self.mean._asdict().items()}
        goal["goal_heading_rad"] = base.goal_heading_rad if heading_rad is None else heading_rad
        taught = build(Task, {**asdict(base), **goal, "tilt_limit_rad": 1.57}, "goal")
        ratio = math.tan(taught.arrival_tilt_rad) / math.tan(base.arrival_tilt_rad)
        tilts = {
            name: math.atan(ratio * math.tan(getattr(base, name)))
            for name in ("tilt_limit_rad", "start_tilt_min_rad", "start_tilt_max_rad")
        }
        return build(Task, {**asdict(taught), **tilts}, "goal")
