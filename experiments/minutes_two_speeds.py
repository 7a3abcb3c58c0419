"""Two speeds, 0.05 and 0.1 m/s: `experiments.minutes` with other cases."""

from __future__ import annotations

from collections.abc import Sequence

from experiments.campaign import Job, Options
from experiments.minutes import GIVEN, LEARNED, Case, draw, jobs_of, run

__all__ = ["NAME", "draw", "jobs", "run"]

NAME = "minutes-two-speeds"
CASES: Sequence[Case] = (
    ("two-speeds", "as built", GIVEN, 5.0),
    ("two-speeds", "as built", LEARNED, 5.0),
)


def jobs(options: Options) -> Sequence[Job]:
    """One for each case and seed."""
    return jobs_of(CASES, options)
