"""The paper's Table II on both plants: controllable cells and docking time after 60 robot-minutes.

Rows of the experiment `table2-common` count only the starts that all controllers of a seed dock from (their share is
in `controllable_percent`): a mean time over different sets is not a comparison.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from docking.task import Task
from experiments.campaign import Job, Options
from experiments.evaluation import World, law_times, score
from experiments.export import export
from experiments.files import write_atomically
from experiments.intervals import Interval, interval, paired
from experiments.learners import BEST, GRID_ALPHA, GRID_BETA, HAND, LEARNERS, TEACHER, law, learned_rows
from experiments.picture import picture
from experiments.problem import PLANTS, Problem
from experiments.reach_avoid import solve
from experiments.rows import Row, select
from experiments.scoring import Label, rows_of
from experiments.starts import DISTANCES_M, protocol_starts
from experiments.training import Training

NAME = "table2"
COMMON = "table2-common"
SEEDS, MINUTES = 100, 60.0
PAPER: Mapping[str, tuple[float, float]] = {
    "LC, hand-tuned": (44.4, 14.00),
    "RL": (53.2, 11.84),
    "RL-LC": (60.8, 11.78),
    "RL without adjoining": (42.3, 11.85),
}
"""Controllable cells in % and mean docking time in s, Table II."""
CEILING, GRID = "ceiling", "LC, best of the grid"


def jobs(options: Options) -> Sequence[Job]:
    """For each plant the ceiling, the grid of gains, and one job per seed with every learner."""
    minutes = MINUTES if options.minutes is None else options.minutes
    common = {"minutes": minutes, "noise": options.plant_noise, "policies": options.policies}
    seeds = options.seeds_or(SEEDS)
    unseeded: list[Job] = [{"plant": plant, "seed": None, "what": what} for plant in PLANTS for what in (CEILING, GRID)]
    return [*unseeded, *({"plant": plant, "seed": seed, **common} for seed in seeds for plant in PLANTS)]


def run(job: Job) -> Sequence[Row]:
    """One job."""
    plant = str(job["plant"])
    if job["seed"] is None:
        return _ceiling(plant) if job["what"] == CEILING else _grid(plant)
    times, rows = _laws(job)
    for name in LEARNERS:
        times[name], learned = _learned(job, name)
        rows += learned
    return [*rows, *_common(job, times)]


def _world(job: Job) -> World:
    return World(Task(), str(job["plant"]), float(job["noise"] or 0.0), int(job["seed"] or 0))


def _laws(job: Job) -> tuple[dict[str, NDArray[np.float64]], list[Row]]:
    """The linear controllers need no training; noise makes them differ from seed to seed."""
    world, rows, times = _world(job), [], {}
    named = {"LC, hand-tuned": HAND, "LC, the teacher": TEACHER, "LC, best-tuned": BEST}
    for name, gains in named.items():
        began = time.process_time()
        times[name] = law_times(world, law(gains[world.plant], world.task), protocol_starts())
        rows += rows_of(Label(NAME, world.plant, name, world.seed), times[name], time.process_time() - began)
    return times, rows


def _learned(job: Job, name: str) -> tuple[NDArray[np.float64], list[Row]]:
    world, learner, minutes = _world(job), LEARNERS[name], float(job["minutes"] or 0.0)
    training = Training(world.task, learner.settings, learner.protocol(world.plant, world.noise), world.seed)
    (checkpoint,) = training.checkpoints((minutes,))
    times = learner.times_s(world, checkpoint.policy, protocol_starts())
    if job["policies"]:
        export(checkpoint.policy, Path(str(job["policies"])), f"{NAME}-{world.plant}-{name}-{world.seed}")
    return times, learned_rows(Label(NAME, world.plant, name, world.seed, minutes), times, checkpoint)


def _common(job: Job, times: Mapping[str, NDArray[np.float64]]) -> list[Row]:
    """Over the starts that all dock from; the compared ones are those of the paper's table."""
    reached = np.all([np.isfinite(times[name]) for name in PAPER], axis=0)
    if not reached.any():
        return []
    share, plant, seed, minutes = 100.0 * float(reached.mean()), str(job["plant"]), job["seed"], job["minutes"]
    return [
        Row(
            COMMON,
            plant,
            name,
            int(seed or 0),
            float(minutes or 0),
            None,
            share,
            float(times[name][reached].mean()),
            None,
        )
        for name in PAPER
    ]


def _ceiling(plant: str) -> list[Row]:
    began, starts = time.process_time(), protocol_starts()
    times = solve(Problem(plant=plant)).time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)
    core_s = time.process_time() - began
    return rows_of(Label(NAME, plant, CEILING), times, core_s)


def _grid(plant: str) -> list[Row]:
    """The best gains of the grid, found anew; the controller's name says which."""
    began, world, starts = time.process_time(), World(Task(), plant), protocol_starts()
    side = -1.0 if plant == "printed" else 1.0
    found = {
        (side * beta, alpha): law_times(world, law((side * beta, alpha), world.task), starts)
        for beta, alpha in product(GRID_BETA.tolist(), GRID_ALPHA.tolist())
    }
    beta, alpha = max(found, key=lambda gains: score(found[gains]).controllable_percent)
    name = f"{GRID} ({beta:g} beta + {alpha:g} alpha)"
    core_s = time.process_time() - began
    return rows_of(Label(NAME, plant, name), found[beta, alpha], core_s)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """The table as text and as a picture."""
    with write_atomically(folder / f"{NAME}.md") as file:
        file.write(text(rows))

    def paint(axes: list[Axes]) -> None:
        for plant, panel in zip(PLANTS, axes, strict=True):
            names = [name for name in _names(rows, plant) if name != CEILING]
            for row in select(rows, experiment=NAME, plant=plant, controller=CEILING, start_distance_m=None):
                panel.axvline(row.controllable_percent, color="k", ls="--", lw=1.0, label=CEILING)
            shares = [_share(rows, plant, name) for name in names]
            panel.barh(names, [s.mean for s in shares], xerr=[np.nan_to_num(s.half_width) for s in shares], color="C0")
            known = [(PAPER[name][0], name) for name in names if name in PAPER and plant == "printed"]
            panel.plot([x for x, _ in known], [y for _, y in known], "D", color="C3", label="the paper")
            panel.invert_yaxis()
            panel.set(title=plant, xlabel="controllable cells, %", xlim=(0, 100))
        axes[1].legend(loc="lower center", bbox_to_anchor=(0.5, 1.08), ncols=2)

    return [folder / f"{NAME}.md", picture(folder / f"{NAME}.png", paint, columns=2)]


def text(rows: Sequence[Row]) -> str:
    """Markdown: a table per plant, then the paired differences."""
    parts = []
    for plant in PLANTS:
        head = ["controller", "controllable, %", "docking time, s", *(f"{d:g} m" for d in DISTANCES_M)]
        lines = [head, ["---"] * len(head), *(_line(rows, plant, name) for name in _names(rows, plant))]
        table = "\n".join("| " + " | ".join(line) + " |" for line in lines)
        parts += [f"### {plant}", table, *_differences(rows, plant), _common_text(rows, plant)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _names(rows: Sequence[Row], plant: str) -> list[str]:
    return list(dict.fromkeys(row.controller for row in select(rows, experiment=NAME, plant=plant)))


def _share(rows: Sequence[Row], plant: str, name: str, distance_m: float | None = None) -> Interval:
    chosen = select(rows, experiment=NAME, plant=plant, controller=name, start_distance_m=distance_m)
    return interval([row.controllable_percent for row in chosen])


def _line(rows: Sequence[Row], plant: str, name: str) -> list[str]:
    chosen = select(rows, experiment=NAME, plant=plant, controller=name, start_distance_m=None)
    share, duration = str(_share(rows, plant, name)), str(interval([row.docking_time_s for row in chosen]))
    if plant == "printed" and name in PAPER:
        share, duration = f"{share} (paper {PAPER[name][0]})", f"{duration} (paper {PAPER[name][1]:.2f})"
    return [name, share, duration, *(f"{_share(rows, plant, name, d).mean:.1f}" for d in DISTANCES_M)]


def _differences(rows: Sequence[Row], plant: str) -> list[str]:
    """Paired by seed: the paper's order, and RL-LC against its teacher."""
    pairs = (
        ("RL-LC", "RL"),
        ("RL", "RL without adjoining"),
        ("RL-LC", "LC, the teacher"),
        ("RL-LC, motion model", "LC, the teacher"),
        ("RL-LC, motion model", "LC, best-tuned"),
    )
    shares = {
        name: [
            r.controllable_percent
            for r in select(rows, experiment=NAME, plant=plant, controller=name, start_distance_m=None)
        ]
        for pair in pairs
        for name in pair
    }
    found = [(a, b, paired(shares[a], shares[b])) for a, b in pairs if shares[a] and len(shares[a]) == len(shares[b])]
    return ["\n".join(f"- {a} minus {b}: {difference} points" for a, b, difference in found)]


def _common_text(rows: Sequence[Row], plant: str) -> str:
    chosen = select(rows, experiment=COMMON, plant=plant)
    if not chosen:
        return ""
    share = interval([row.controllable_percent for row in select(chosen, controller="RL")])
    times = ", ".join(f"{n} {interval([r.docking_time_s for r in select(chosen, controller=n)])} s" for n in PAPER)
    return f"Over the starts that all four dock from ({share} %): {times}."
