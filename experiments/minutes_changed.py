"""Robots that are not as they were built, shown the goal and nothing else: `experiments.minutes` with other cases."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.campaign import Job, Options
from experiments.minutes import GIVEN, LEARNED, Case, jobs_of, run
from experiments.minutes_picture import draw

__all__ = ["NAME", "draw", "jobs", "run"]

NAME = "minutes-changed"
ROBOTS = ("half turn rate", "unequal wheels", "150 ms delay", "pan zero off 3 deg", "camera aside", "focal length x1.3")
CASES: Sequence[Case] = tuple(
    ("two-speeds", robot, method, (2.0, 5.0)) for robot in ROBOTS for method in (GIVEN, LEARNED)
)


def jobs(options: Options) -> Sequence[Job]:
    """One for each case and seed."""
    return jobs_of(CASES, options)
