"""Tables and pictures of what was learned in minutes: each seed beside its ceiling, and shares against robot time."""

from __future__ import annotations

import csv
import math
import statistics
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import ScalarFormatter
from numpy.typing import NDArray

from experiments.files import write_atomically
from experiments.minutes_comparison import NAMES, PAPER
from experiments.minutes_scoring import Driven
from experiments.picture import picture
from experiments.rows import Row, select

CEILING, COMMON, MIRROR = "ceiling", ", on common starts", ", mirror"
HEADER = ("controller", "robot_minutes", "seeds", "ceiling_percent", "median_percent", "worst_percent", "median_share",
          "worst_share", "median_time_ratio", "worst_time_ratio", "mirror_percent")  # fmt: skip
_SHOWN_DISTANCE, _EVERY = 2, 12
"""Of the protocol's distances, and every so many of its starts are drawn."""
Line = tuple[str | int | float, ...]


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """The table of shares, and the last shares of all seeds as a picture."""
    name = rows[-1].experiment
    table = list(shares(rows))
    path = folder / f"{name}-shares.csv"
    with write_atomically(path) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows([f"{x:.4g}" if isinstance(x, float) else x for x in line] for line in table)
    last = {line[0]: line for line in table}.values()

    def paint(axes: list[Axes]) -> None:
        for place, line in enumerate(last):
            mine = [row.controllable_percent for row in means(rows, str(line[0]), float(line[1]))]
            axes[0].plot([place] * len(mine), mine, "_", color="C0")
            axes[0].plot(place, float(line[3]), "x", color="C3")
        axes[0].set_xticks(range(len(last)), [str(line[0]) for line in last], rotation=25, ha="right", fontsize=6)
        axes[0].set(ylabel="starts that reach the goal, %", title="each seed (dash) and the ceiling (cross)")

    return [path, picture(folder / f"{name}-seeds.png", paint, columns=1, height_in=5.0)]


def curves(rows: Sequence[Row], folder: Path) -> Path:
    """Shares and times against robot time: our own methods, the paper's learner, the laws, the ceiling."""

    def paint(axes: list[Axes]) -> None:
        for number, name in enumerate(_learners(rows)):
            _curve(axes, rows, name, f"C{number}")
        laws = [name for name in NAMES if name != PAPER]
        ceiling = next(row.controller for row in rows if row.controller.startswith(CEILING))
        for style, name in zip((":", "-.", "--"), (*laws, ceiling), strict=True):
            row = select(rows, controller=name, start_distance_m=None)[0]
            label = CEILING if name == ceiling else name
            axes[0].axhline(row.controllable_percent, color="k", lw=1.0, ls=style, label=label)
            axes[1].axhline(row.docking_time_s or math.nan, color="k", lw=1.0, ls=style)
        axes[0].set(xscale="log", xlabel="robot-minutes", ylabel="starts that reach the goal, %", ylim=(0, 70))
        axes[1].set(xscale="log", xlabel="robot-minutes", ylabel="mean docking time, s", ylim=(10, 16))
        for panel in axes:
            panel.xaxis.set_major_formatter(ScalarFormatter())
        axes[0].set_title("median of the seeds; band: all of them")
        axes[0].figure.legend(loc="outside lower center", ncols=3)

    return picture(folder / f"{rows[-1].experiment}.png", paint, columns=2, height_in=5.0)


def shares(rows: Sequence[Row]) -> Iterator[Line]:
    """One line for each case and time: as `HEADER` says; shares of the ceiling, times over the ceiling's."""
    for name in _learners(rows):
        if name == PAPER:
            continue
        for minutes in sorted({row.robot_minutes or 0.0 for row in select(rows, controller=name)}):
            percent = [row.controllable_percent for row in means(rows, name, minutes)]
            best = means(rows, f"{CEILING}:" + name.split(":", 1)[1], minutes)[0].controllable_percent
            middle, worst = statistics.median(percent), min(percent)
            ratios = _time_ratios(rows, name, minutes)
            mirrored = [row.controllable_percent for row in means(rows, name + MIRROR, minutes)]
            yield (
                name, minutes, len(percent), best, middle, worst, middle / best, worst / best,
                statistics.median(ratios), max(ratios), statistics.mean(mirrored),
            )  # fmt: skip


def worst_seed(rows: Sequence[Row], controller: str, minutes: float) -> int | None:
    """The seed of the least share; None without such rows."""
    found = means(rows, controller, minutes)
    return min(found, key=lambda row: row.controllable_percent).seed if found else None


def failure(driven: Sequence[Driven], reachable: NDArray[np.bool_], folder: Path) -> Path:
    """Plan view of starts 1.5 m away that could be reached: those that are, and those that are not."""
    at = np.flatnonzero(reachable & (np.arange(len(reachable)) // (len(reachable) // 5) == _SHOWN_DISTANCE))[::_EVERY]
    ends = {int(n): bool(v == 1) for line in driven for n, v in zip(line.robots, line.verdicts, strict=True)}

    def paint(axes: list[Axes]) -> None:
        for panel, good in zip(axes, (True, False), strict=True):
            chosen = [n for n in at if ends[int(n)] is good]
            for n in chosen:
                path = np.array([line.poses[line.robots == n][0] for line in driven if n in line.robots])
                panel.plot(path[:, 1], path[:, 0], lw=0.8)
                panel.plot(*path[-1, 1::-1], "." if good else "x", color="k", markersize=4)
            panel.plot(0, 0, "o", color="tab:green", markersize=7)
            panel.set(xlabel="along the table, m", ylabel="from the object, m", aspect="equal")
            panel.set_title(f"{len(chosen)} of {len(at)} starts {'reach the goal' if good else 'do not'}")

    return picture(folder / "minutes-failure.png", paint, columns=2, height_in=5.0)


def means(rows: Sequence[Row], controller: str, minutes: float) -> list[Row]:
    """Rows over all start distances, seed by seed."""
    found = select(rows, controller=controller, start_distance_m=None, robot_minutes=minutes)
    return sorted(found, key=lambda row: row.seed or 0)


def _learners(rows: Sequence[Row]) -> list[str]:
    """Names of those who learn, the ceiling and the rows about them left out."""
    names = dict.fromkeys(row.controller for row in rows if row.robot_minutes is not None)
    return [name for name in names if not name.endswith((COMMON, MIRROR)) and not name.startswith(CEILING)]


def _time_ratios(rows: Sequence[Row], name: str, minutes: float) -> list[float]:
    mine = means(rows, name + COMMON, minutes)
    best = means(rows, name.replace(":", f" {CEILING}:", 1) + COMMON, minutes)
    pairs = zip(mine, best, strict=True)
    return [(a.docking_time_s or math.nan) / (b.docking_time_s or math.nan) for a, b in pairs]


def _curve(axes: list[Axes], rows: Sequence[Row], name: str, colour: str) -> None:
    minutes = sorted({row.robot_minutes or 0.0 for row in select(rows, controller=name)})
    found = [means(rows, name, minute) for minute in minutes]
    percent = [[row.controllable_percent for row in line] for line in found]
    times = [[row.docking_time_s or math.nan for row in line] for line in found]
    axes[0].plot(minutes, [statistics.median(line) for line in percent], ".-", color=colour, label=name)
    axes[0].fill_between(
        minutes, [min(line) for line in percent], [max(line) for line in percent], color=colour, alpha=0.15, lw=0
    )
    axes[1].plot(minutes, [statistics.median(line) for line in times], ".-", color=colour)
