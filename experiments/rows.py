"""Rows of results: one per seed and start distance, written as CSV that other people's scripts can read."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from experiments.files import write_atomically


@dataclass(frozen=True, slots=True)
class Row:
    """One measurement. None is an empty field of the CSV file."""

    experiment: str
    plant: str
    """`geometric` (true) or `printed` (the paper's)."""
    controller: str
    seed: int | None
    """None where nothing is random."""
    robot_minutes: float | None
    """Robot time learned so far; None where nothing is learned."""
    start_distance_m: float | None
    """None = mean over all start distances."""
    controllable_percent: float
    """Share of the starts that reach the goal."""
    docking_time_s: float | None
    """Mean over the starts that reach the goal; None if none does."""
    robot_seconds_per_core_second: float | None
    """Robot time simulated (and learned) in a second of one core's processor time."""


COLUMNS = tuple(f.name for f in fields(Row))
_WORDS = ("experiment", "plant", "controller")


def row_of(table: dict[str, object]) -> Row:
    """A row from plain values, e.g. out of JSON or CSV; empty text is None.

    Raises:
        ValueError: a column is missing, unknown or not a number.
    """
    if set(table) != set(COLUMNS):
        raise ValueError(f"columns must be {', '.join(COLUMNS)}; got {', '.join(table)}")
    numbers = {name: _number(table[name]) for name in COLUMNS if name not in _WORDS}
    percent, seed = numbers["controllable_percent"], numbers["seed"]
    if percent is None:
        raise ValueError("controllable_percent must be a number")
    return Row(
        experiment=str(table["experiment"]),
        plant=str(table["plant"]),
        controller=str(table["controller"]),
        seed=None if seed is None else int(seed),
        robot_minutes=numbers["robot_minutes"],
        start_distance_m=numbers["start_distance_m"],
        controllable_percent=percent,
        docking_time_s=numbers["docking_time_s"],
        robot_seconds_per_core_second=numbers["robot_seconds_per_core_second"],
    )


def _number(value: object) -> float | None:
    return None if value is None or value == "" else float(str(value))


def write_csv(path: Path, rows: Iterable[Any], columns: Sequence[str] = COLUMNS) -> None:
    """Write rows, dataclasses with these fields, under a header of the column names, atomically."""
    with write_atomically(path) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([_text(value) for value in asdict(row).values()] for row in rows)


def _text(value: object) -> object:
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else value


def read_csv(path: Path) -> list[Row]:
    """Rows of a file written by `write_csv`."""
    with path.open(newline="", encoding="utf-8") as file:
        return [row_of(dict(line)) for line in csv.DictReader(file)]


def select(rows: Sequence[Row], **equal: object) -> list[Row]:
    """Rows whose columns equal the given values, e.g. `select(rows, plant="printed", start_distance_m=None)`."""
    return [row for row in rows if all(getattr(row, name) == value for name, value in equal.items())]
