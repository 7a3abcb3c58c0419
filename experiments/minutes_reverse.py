"""Driving backwards is an action, so that a bad approach is given up: `experiments.minutes` with other cases."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.campaign import Job, Options
from experiments.minutes import GIVEN, LEARNED, Case, jobs_of, run
from experiments.minutes_picture import draw

__all__ = ["NAME", "draw", "jobs", "run"]

NAME = "minutes-reverse"
CASES: Sequence[Case] = (
    ("reverse", "as built", GIVEN, (1.0, 2.0, 5.0)),
    ("reverse", "as built", LEARNED, (1.0, 2.0, 5.0)),
)


def jobs(options: Options) -> Sequence[Job]:
    """One for each case and seed."""
    return jobs_of(CASES, options)
