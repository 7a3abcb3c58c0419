"""Robots that change after five minutes and are shown their goal again. As `experiments.minutes`, with other cases."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.campaign import Job, Options
from experiments.minutes import CHANGED, GIVEN, LEARNED, Case, jobs_of, run
from experiments.minutes_changed import ROBOTS
from experiments.minutes_picture import draw

__all__ = ["NAME", "draw", "jobs", "run"]

NAME = "minutes-mid-session"
CASES: Sequence[Case] = tuple(
    ("two-speeds", robot + CHANGED, method, (2.0, 5.0)) for robot in ROBOTS for method in (GIVEN, LEARNED)
)


def jobs(options: Options) -> Sequence[Job]:
    """One for each case and seed."""
    return jobs_of(CASES, options)
