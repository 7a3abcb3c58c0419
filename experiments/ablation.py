"""What each parameter of the paper's method is worth: swept one by one, after 60 robot-minutes of random exploration.

Both models, on the geometric plant; the holds on both plants. A fixed hold counts every successor: what holding until
the cell changes adds to the best of them is what the adjoining property is worth. With other cells the goal cell is
another one, and so is the task.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from docking.angles import DEG
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.evaluation import World, policy_times
from experiments.files import write_atomically
from experiments.intervals import Interval, interval
from experiments.learners import EXITS, MOTION, learned_rows
from experiments.picture import picture
from experiments.rows import Row, select
from experiments.scoring import Label
from experiments.starts import protocol_starts
from experiments.training import Protocol, Training

NAME = "ablation"
SEEDS, MINUTES = 20, 60.0
MODELS = {"exits": EXITS, "motion": MOTION}
AS_IS = "as in the paper"


@dataclass(frozen=True)
class Case:
    """What is unlike the paper."""

    settings: Mapping[str, Any] = field(default_factory=dict)
    protocol: Mapping[str, Any] = field(default_factory=dict)
    task: Mapping[str, Any] = field(default_factory=dict)


def _cells(count: int) -> Case:
    return Case(task={"beta_cells": count, "alpha_cells": count})


HOLDS: Mapping[str, Case] = {
    AS_IS: Case(),
    "hold 0.125 s": Case({"hold_periods": 1}),
    "hold 0.25 s": Case({"hold_periods": 2}),
    "hold 0.5 s": Case({"hold_periods": 4}),
    "hold 1 s": Case({"hold_periods": 8}),
}
CASES: Mapping[str, Case] = {
    **HOLDS,
    "adjoining distance 2": Case({"adjoining_cells": 2}),
    "15 cells": _cells(15),
    "21 cells": _cells(21),
    "41 cells": _cells(41),
    "5 sweeps": Case({"sweeps": 5}),
    "20 sweeps": Case({"sweeps": 20}),
    "learning rate 1/visits": Case({"learning_rate": "inverse"}),
    "process noise 0.02": Case({"process_noise": 0.02}),
    "process noise 0.2": Case({"process_noise": 0.2}),
    "no mirror": Case({"mirror": False}),
    "unknown is bad (-50)": Case({"unknown_value": -50.0}),
    "too close is a sink": Case({"too_close": "sink"}),
    "free reverse": Case(protocol={"reverse_s": 0.0}),
    "plant noise 10 %": Case(protocol={"plant_noise": 0.1}),
    "plant noise 30 %": Case(protocol={"plant_noise": 0.3}),
    "percept noise 0.5 deg": Case(protocol={"percept_noise_rad": 0.5 * DEG}),
    "percept noise 1 deg": Case(protocol={"percept_noise_rad": 1.0 * DEG}),
    "percept noise 2 deg": Case(protocol={"percept_noise_rad": 2.0 * DEG}),
}
"""Percept noise disturbs the training only: the policy is evaluated without it."""


def jobs(options: Options) -> Sequence[Job]:
    """One per plant, model, case and seed."""
    minutes = MINUTES if options.minutes is None else options.minutes
    shared = {"minutes": minutes, "noise": options.plant_noise}
    cases = [("geometric", case) for case in CASES] + [("printed", case) for case in HOLDS]
    return [
        {"plant": plant, "model": model, "case": case, "seed": seed, **shared}
        for seed in options.seeds_or(SEEDS)
        for plant, case in cases
        for model in MODELS
    ]


def run(job: Job) -> Sequence[Row]:
    """Train, evaluate."""
    case, plant, minutes, seed = (
        CASES[str(job["case"])],
        str(job["plant"]),
        float(job["minutes"] or 0),
        int(job["seed"] or 0),
    )
    protocol = replace(Protocol(plant=plant, plant_noise=float(job["noise"] or 0.0)), **case.protocol)
    task, settings = replace(Task(), **case.task), replace(MODELS[str(job["model"])], **case.settings)
    training = Training(task, settings, protocol, seed)
    (checkpoint,) = training.checkpoints((minutes,))
    times = policy_times(World(task, plant, protocol.plant_noise, seed), checkpoint.policy, protocol_starts(task))
    return learned_rows(Label(NAME, plant, f"{job['model']}, {job['case']}", seed, minutes), times, checkpoint)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Bars of both models, and a table."""
    with write_atomically(folder / f"{NAME}.md") as file:
        file.write(text(rows))

    def paint(axes: list[Axes]) -> None:
        for (plant, cases), panel in zip((("geometric", CASES), ("printed", HOLDS)), axes, strict=True):
            places = np.arange(len(cases))
            for number, model in enumerate(MODELS):
                found = [share(rows, plant, model, case) for case in cases]
                means, halves = [i.mean for i in found], np.nan_to_num([i.half_width for i in found])
                panel.barh(places + 0.4 * number, means, 0.4, xerr=halves, label=f"{model} model", color=f"C{number}")
            panel.set_yticks(places + 0.2, list(cases))
            panel.invert_yaxis()
            panel.set(title=plant, xlabel="controllable cells, %", xlim=(0, 100))
        axes[1].legend(loc="lower center", bbox_to_anchor=(0.5, 1.05), ncols=2)

    return [folder / f"{NAME}.md", picture(folder / f"{NAME}.png", paint, columns=2, height_in=6.0)]


def share(rows: Sequence[Row], plant: str, model: str, case: str) -> Interval:
    """Controllable cells of a case, in %."""
    chosen = select(rows, plant=plant, controller=f"{model}, {case}", start_distance_m=None)
    return interval([row.controllable_percent for row in chosen])


def text(rows: Sequence[Row]) -> str:
    """Markdown tables."""
    parts = []
    for plant, cases in (("geometric", CASES), ("printed", HOLDS)):
        lines = [f"| {case} | " + " | ".join(str(share(rows, plant, m, case)) for m in MODELS) + " |" for case in cases]
        head = f"| {plant} | " + " | ".join(f"{model} model, %" for model in MODELS) + " |"
        parts.append("\n".join([head, "| --- |" + " --- |" * len(MODELS), *lines]))
    return "\n\n".join(parts) + "\n"
