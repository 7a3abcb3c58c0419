"""Controllability against robot time (the paper's Fig. 5), all learners beside the ceiling; and the robot's profile.

Profiles: `simulation` is Table I's second column over the protocol's starts; `robot` is its first column: 15 cells, 9
deg/s, every trial begins where the reverse ends, at a tilt of 20 deg (0.95 m), and too close is a sink.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from docking.angles import DEG
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.evaluation import World
from experiments.files import write_atomically
from experiments.intervals import interval
from experiments.learners import LEARNERS, learned_rows
from experiments.picture import picture
from experiments.problem import Problem
from experiments.reach_avoid import solve
from experiments.rows import Row, select
from experiments.scoring import Label, rows_of
from experiments.starts import DISTANCES_M, protocol_starts
from experiments.training import Training

NAME = "curves"
CEILING = "ceiling"
SEEDS = 20
_FIRST = (2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0)
_LATER = (120.0, 300.0, 600.0)
_LATE = (1200.0, 2000.0, 3000.0)
_LONG: Mapping[tuple[str, str], tuple[float, ...]] = {
    ("geometric", "RL"): _FIRST + _LATER,
    ("geometric", "RL, motion model"): _FIRST + _LATER,
    ("geometric", "Q-learning"): _FIRST + _LATER + _LATE,
    ("printed", "Q-learning"): _FIRST + _LATER + _LATE,
}
"""Robot minutes at which these are looked at; all others until 60."""


@dataclass(frozen=True)
class Profile:
    """A task and where its trials start."""

    task: Task
    distances_m: tuple[float, ...]
    start_distances_m: tuple[float, float]
    too_close: str
    """As in `Settings`."""
    plants: tuple[str, ...]
    learners: tuple[str, ...]


PROFILES: Mapping[str, Profile] = {
    "simulation": Profile(Task(), DISTANCES_M, (1.0, 2.0), "ignored", ("geometric", "printed"), tuple(LEARNERS)),
    "robot": Profile(
        replace(Task(), beta_cells=15, alpha_cells=15, turn_rate_radps=9 * DEG),
        (0.95,),
        (0.95, 0.95),
        "sink",
        ("geometric",),
        ("RL", "RL-LC", "RL, motion model", "RL-LC, motion model"),
    ),
}


def jobs(options: Options) -> Sequence[Job]:
    """A ceiling for each profile and plant, and one job per profile, plant, learner and seed."""
    cases = [(name, plant, profile) for name, profile in PROFILES.items() for plant in profile.plants]
    seeds, longest = options.seeds_or(SEEDS), options.minutes
    ceilings: list[Job] = [{"profile": name, "plant": plant, "controller": CEILING} for name, plant, _ in cases]
    learners = [(name, plant, learner) for name, plant, profile in cases for learner in profile.learners]
    trained: list[Job] = [
        {
            "profile": name,
            "plant": plant,
            "controller": learner,
            "seed": seed,
            "longest": longest,
            "noise": options.plant_noise,
        }
        for seed in seeds
        for name, plant, learner in learners
    ]
    return ceilings + trained


def run(job: Job) -> Sequence[Row]:
    """One job."""
    return _ceiling(job) if job["controller"] == CEILING else _curve(job)


def _label(job: Job, minutes: float | None = None) -> Label:
    seed = job.get("seed")
    experiment = NAME if job["profile"] == "simulation" else f"{NAME}-{job['profile']}"
    return Label(experiment, str(job["plant"]), str(job["controller"]), None if seed is None else int(seed), minutes)


def _ceiling(job: Job) -> list[Row]:
    profile = PROFILES[str(job["profile"])]
    began, starts = time.process_time(), protocol_starts(profile.task, profile.distances_m)
    problem = Problem(plant=str(job["plant"]), task=profile.task, actions=profile.task.actions)
    times = solve(problem).time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)
    return rows_of(_label(job), times, time.process_time() - began, profile.distances_m)


def _curve(job: Job) -> list[Row]:
    profile, name, plant = PROFILES[str(job["profile"])], str(job["controller"]), str(job["plant"])
    learner, seed, noise = LEARNERS[name], int(job["seed"] or 0), float(job["noise"] or 0.0)
    protocol = replace(learner.protocol(plant, noise), start_distances_m=profile.start_distances_m)
    settings = replace(learner.settings, too_close=profile.too_close)
    training = Training(profile.task, settings, protocol, seed)
    world, starts = World(profile.task, plant, noise, seed), protocol_starts(profile.task, profile.distances_m)
    rows = []
    for checkpoint in training.checkpoints(_minutes(job)):
        times = learner.times_s(world, checkpoint.policy, starts)
        rows += learned_rows(_label(job, checkpoint.minutes), times, checkpoint, profile.distances_m)
    return rows


def _minutes(job: Job) -> tuple[float, ...]:
    planned: tuple[float, ...] = _FIRST
    if job["profile"] == "simulation":
        planned = _LONG.get((str(job["plant"]), str(job["controller"])), _FIRST)
    if job["longest"] is None:
        return planned
    longest = float(job["longest"])
    return (*(minutes for minutes in planned if minutes < longest), longest)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Curves with bands of the 95 % interval, and what they say in words."""
    with write_atomically(folder / f"{NAME}.md") as file:
        file.write(text(rows))
    cases = [(NAME, "geometric"), (NAME, "printed"), (f"{NAME}-robot", "geometric")]

    def paint(axes: list[Axes]) -> None:
        for (experiment, plant), panel in zip(cases, axes, strict=True):
            chosen = select(rows, experiment=experiment, plant=plant, start_distance_m=None)
            for row in select(chosen, controller=CEILING):
                panel.axhline(row.controllable_percent, color="k", lw=1.0, ls="--", label=CEILING)
            for number, name in enumerate(LEARNERS):
                band(panel, *curve(chosen, name), name, f"C{number}")
            panel.set(ylim=(0, 100), title=f"{experiment}, {plant}")
            minutes_axis(panel)
        axes[0].set_ylabel("controllable cells, %")
        legend_below(axes[0])

    return [folder / f"{NAME}.md", picture(folder / f"{NAME}.png", paint, columns=3, height_in=4.6)]


def minutes_axis(panel: Axes) -> None:
    """A logarithmic axis of what was drawn, its ticks as plain numbers."""
    panel.set(xscale="log", xlabel="robot time, minutes")
    low, high = panel.get_xlim()
    panel.set_xticks([minutes for minutes in (1, 2, 5, 10, 20, 60, 200, 600, 3000) if low <= minutes <= high])
    panel.xaxis.set_major_formatter("{x:g}")
    panel.minorticks_off()


def legend_below(panel: Axes) -> None:
    """A legend of this panel's lines below the whole figure."""
    figure = panel.get_figure(root=True)
    if figure is not None:
        figure.legend(*panel.get_legend_handles_labels(), loc="outside lower center", ncols=3)


Line = NDArray[np.float64]


def curve(rows: Sequence[Row], controller: str) -> tuple[Line, Line, Line]:
    """Minutes, mean over the seeds and half width of its interval, [checkpoints] each; rows without distance."""
    chosen = select(rows, controller=controller, start_distance_m=None)
    minutes = sorted({row.robot_minutes for row in chosen if row.robot_minutes is not None})
    found = [interval([row.controllable_percent for row in select(chosen, robot_minutes=m)]) for m in minutes]
    return np.array(minutes), np.array([i.mean for i in found]), np.nan_to_num([i.half_width for i in found])


def band(panel: Axes, minutes: Line, mean: Line, half: Line, name: str, colour: str) -> None:
    """Draw a curve with its interval."""
    if len(minutes):
        panel.plot(minutes, mean, color=colour, label=name)
        panel.fill_between(minutes, mean - half, mean + half, color=colour, alpha=0.15, lw=0)


def text(rows: Sequence[Row]) -> str:
    """What the curves say: how soon each learner is at 90 % of what it has at 60 minutes, and what Q-learning costs."""
    lines = []
    for experiment, plant in dict.fromkeys((row.experiment, row.plant) for row in rows):
        chosen = select(rows, experiment=experiment, plant=plant, start_distance_m=None)
        ceiling = [row.controllable_percent for row in select(chosen, controller=CEILING)]
        lines += [f"### {experiment}, {plant}", *(f"- ceiling: {percent:.1f} %" for percent in ceiling)]
        lines += [_sentence(chosen, name) for name in LEARNERS if select(chosen, controller=name)]
        lines += [
            _factor(chosen, name) for name in ("RL", "RL, motion model") if select(chosen, controller="Q-learning")
        ]
    return "\n".join(lines) + "\n"


def _sentence(rows: Sequence[Row], name: str) -> str:
    minutes, mean, half = curve(rows, name)
    last = min(60.0, float(minutes[-1]))
    at = int(np.flatnonzero(minutes == last)[0])
    soon = crossing(minutes[: at + 1], mean[: at + 1], 0.9 * mean[at])
    words = f"- {name}: {mean[at]:.1f} +- {half[at]:.1f} % at {last:g} minutes, 90 % of it after {soon:.0f}"
    return f"{words}; {mean[-1]:.1f} +- {half[-1]:.1f} % at {minutes[-1]:g}" if minutes[-1] > last else words


def _factor(rows: Sequence[Row], name: str) -> str:
    """Robot time of Q-learning over that of another learner, for the controllability that Q-learning has at its end."""
    minutes, mean, _ = curve(rows, "Q-learning")
    others, level = curve(rows, name), mean[-1]
    if level >= others[1].max():
        return f"- Q-learning ends above {name}"
    factor = crossing(minutes, mean, level) / crossing(others[0], others[1], level)
    return f"- Q-learning needs {factor:.0f} times the robot time of {name} for {level:.1f} %"


def crossing(minutes: Line, percent: Line, level: float) -> float:
    """Robot minutes at which a curve first has a level, linear between checkpoints and from 0 at 0."""
    at = int(np.argmax(percent >= level))
    before, low = (0.0, 0.0) if at == 0 else (float(minutes[at - 1]), float(percent[at - 1]))
    return before + (float(minutes[at]) - before) * (level - low) / (float(percent[at]) - low)
