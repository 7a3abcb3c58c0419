"""Ways to teach and to explore, from the work that the paper discusses, each against robot minutes.

All learn with the motion model unless they are without a model. The teacher is the one of `experiments.learners`.
"""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes

from components.learner.settings import Settings
from docking.linear import Linear
from docking.policy import PolicyTable
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.curves import band, curve, legend_below, minutes_axis
from experiments.evaluation import PLANTS, World, law_times, policy_times
from experiments.files import write_atomically
from experiments.learners import EXPLORE, MOTION, TEACHER, learned_rows
from experiments.picture import picture
from experiments.rows import Row, select
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts
from experiments.training import Protocol, Training
from runtime.params import ConfigurationError

NAME = "schools"
TEACHER_ROW = "the teacher"
NEURAL = "DQN (stable-baselines3)"
SEEDS, NEURAL_SEEDS = 20, 5
"""The neural learner costs a hundred times as much."""
MINUTES = (2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0)
CEILINGS: Mapping[str, float] = {"geometric": 62.5, "printed": 82.2}
"""Controllable cells in %, as the experiment `ceiling` finds them."""
INSTALL = "--neural needs stable-baselines3, which is not installed; run: .venv/bin/pip install --editable '.[neural]'"


@dataclass(frozen=True)
class School:
    """How a learner is taught."""

    settings: Settings = MOTION
    protocol: Mapping[str, Any] = field(default_factory=dict)

    @property
    def asks(self) -> bool:
        """Whether the teacher decides where nothing was learned."""
        return bool(self.protocol.get("teacher_where_unknown"))


_ASK = {"explore": EXPLORE, "teacher_where_unknown": True}
SCHOOLS: Mapping[str, School] = {
    "random exploration": School(),
    "alternate teaching": School(protocol={"cycle": ("lc", "random")}),
    "alternate teaching, own trials": School(protocol={"cycle": ("lc", "greedy"), **_ASK}),
    "two-phase teaching": School(
        protocol={"cycle": ("lc",), "cycle_after": ("greedy",), "switch_minutes": 10.0, **_ASK}
    ),
    "easy missions": School(protocol={"easy_minutes": 30.0}),
    "easy missions, own trials": School(
        protocol={"easy_minutes": 30.0, "cycle": ("random", "greedy"), "explore": EXPLORE}
    ),
    "optimistic exploration": School(replace(MOTION, unknown_value=300.0), {"cycle": ("optimist",)}),
    "Q-learning": School(Settings(method="q-learning")),
    "advantage learning": School(Settings(method="advantage")),
}
"""Two-phase teaching after Smart and Kaelbling 2002: the teacher drives for 10 minutes, then the learner. Easy missions
after Asada 1996: starts near the goal at first, anywhere after 30 minutes. Advantage learning after Baird 1993 and
Gaskett 2002. Optimistic: what was never tried counts as the goal's reward."""


def jobs(options: Options) -> Sequence[Job]:
    """One per plant, school and seed; asked for, the neural learner on the true plant.

    Raises:
        ConfigurationError: it is asked for and its package is not installed.
    """
    shared = {"longest": options.minutes, "noise": options.plant_noise}
    seeds = options.seeds_or(SEEDS)
    taught: list[Job] = [
        {"plant": plant, "school": school, "seed": seed, **shared}
        for seed in seeds
        for plant in PLANTS
        for school in SCHOOLS
    ]
    neural: list[Job] = []
    if options.neural:
        if importlib.util.find_spec("stable_baselines3") is None:
            raise ConfigurationError(INSTALL)
        neural = [{"plant": "geometric", "school": NEURAL, "seed": seed, **shared} for seed in seeds[:NEURAL_SEEDS]]
    teachers: list[Job] = [{"plant": plant, "school": TEACHER_ROW, "seed": None, **shared} for plant in PLANTS]
    return teachers + taught + neural


def run(job: Job) -> Sequence[Row]:
    """One job."""
    plant, name = str(job["plant"]), str(job["school"])
    world = World(Task(), plant, float(job["noise"] or 0.0), int(job["seed"] or 0))
    if name == TEACHER_ROW:
        return rows_of(Label(NAME, plant, name), law_times(world, _teacher(plant), protocol_starts()), 0.0)
    if name == NEURAL:
        neural = importlib.import_module("experiments.neural")
        return list(neural.rows(NAME, name, world, _minutes(job)))
    return _taught(world, name, _minutes(job))


def _taught(world: World, name: str, minutes: Sequence[float]) -> list[Row]:
    school = SCHOOLS[name]
    protocol = Protocol(plant=world.plant, teacher=TEACHER[world.plant], plant_noise=world.noise, **school.protocol)
    training = Training(world.task, school.settings, protocol, world.seed)
    rows = []
    for checkpoint in training.checkpoints(minutes):
        times = _times(world, school, checkpoint.policy)
        rows += learned_rows(Label(NAME, world.plant, name, world.seed, checkpoint.minutes), times, checkpoint)
    return rows


def _times(world: World, school: School, policy: PolicyTable) -> Any:
    return policy_times(world, policy, protocol_starts(), _teacher(world.plant) if school.asks else None)


def _teacher(plant: str) -> Linear:
    return Linear(*TEACHER[plant], Task().turn_rate_radps)


def _minutes(job: Job) -> tuple[float, ...]:
    if job["longest"] is None:
        return MINUTES
    longest = float(job["longest"])
    return (*(minutes for minutes in MINUTES if minutes < longest), longest)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Curves, and a table of a few robot times."""
    with write_atomically(folder / f"{NAME}.md") as file:
        file.write(text(rows))

    def paint(axes: list[Axes]) -> None:
        for plant, panel in zip(PLANTS, axes, strict=True):
            chosen = select(rows, plant=plant, start_distance_m=None)
            panel.axhline(CEILINGS[plant], color="k", lw=1.0, ls="--", label="ceiling")
            for row in select(chosen, controller=TEACHER_ROW):
                panel.axhline(row.controllable_percent, color="k", lw=1.0, ls=":", label=TEACHER_ROW)
            for number, name in enumerate((*SCHOOLS, NEURAL)):
                band(panel, *curve(chosen, name), name, f"C{number}")
            panel.set(ylabel="controllable cells, %", ylim=(0, 100), title=plant)
            minutes_axis(panel)
        legend_below(axes[0])

    return [folder / f"{NAME}.md", picture(folder / f"{NAME}.png", paint, columns=2, height_in=5.2)]


def text(rows: Sequence[Row]) -> str:
    """Markdown: controllable cells, mean over the seeds and 95 % interval, at each robot time."""
    parts = []
    for plant in dict.fromkeys(row.plant for row in rows):
        chosen = select(rows, plant=plant, start_distance_m=None)
        minutes = sorted({row.robot_minutes for row in chosen if row.robot_minutes is not None})
        lines = [[f"{plant}, after minutes", *(f"{m:g}" for m in minutes)], ["---"] * (len(minutes) + 1)]
        for name in (*SCHOOLS, NEURAL):
            found = {m: f"{mean:.1f} +- {half:.1f}" for m, mean, half in zip(*curve(chosen, name), strict=True)}
            if found:
                lines.append([name, *(found.get(m, "") for m in minutes)])
        parts.append("\n".join("| " + " | ".join(line) + " |" for line in lines))
    return "\n\n".join(parts) + "\n"
