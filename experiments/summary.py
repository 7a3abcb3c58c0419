"""Rows averaged over seeds, as lines of text for people: one per controller, start distances side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from experiments.intervals import interval
from experiments.rows import Row, select


def summary(rows: Sequence[Row]) -> Iterator[tuple[str, ...]]:
    """A header, then a line for each plant and controller: share in % / docking time in s, at each start distance.

    Of a learner's robot minutes only the last are shown.
    """
    distances = sorted({row.start_distance_m for row in rows if row.start_distance_m is not None})
    yield ("plant", "controller", "minutes", "seeds", "mean", *(f"{d:g} m" for d in distances))
    last = {(row.plant, row.controller): row.robot_minutes for row in rows}
    for (plant, controller), minutes in last.items():
        line = select(rows, plant=plant, controller=controller, robot_minutes=minutes)
        seeds = len({row.seed for row in line if row.seed is not None})
        parts = (select(line, start_distance_m=distance) for distance in (None, *distances))
        head = (plant, controller, "" if minutes is None else f"{minutes:g}", str(seeds) if seeds else "")
        yield (*head, *(_cell(part) for part in parts))


def _cell(rows: Sequence[Row]) -> str:
    percent = interval([row.controllable_percent for row in rows])
    duration = interval([row.docking_time_s for row in rows])
    return f"{percent} / {duration}" if rows else ""
