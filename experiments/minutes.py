"""Our own learner in minutes: the paper's task at one speed. The robot drives back by itself and is never put anywhere.

Two methods, apart: the kinematic form is given and its numbers are not, or nothing is given. Rows named `ceiling` are
what the best controller reaches on that robot; `on common starts` compares mean times where both arrive.
"""

from __future__ import annotations

import csv
import math
import statistics
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from components.learner.perceptual import Planning
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.ceiling import problem_of as ceiling_problem
from experiments.files import write_atomically
from experiments.minutes_scoring import grid_policy_times
from experiments.minutes_training import Lesson, Trainee
from experiments.picture import picture
from experiments.problem import GRIPPER_M, Problem, action_set
from experiments.reach_avoid import solve
from experiments.robot import ROBOTS
from experiments.rows import Row, select
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts

NAME = "minutes"
SEEDS = 20
GIVEN, LEARNED = "structure-given", "structure-learned"
Case = tuple[str, str, str, float]
"""Action set, robot, method, robot minutes."""
CASES: Sequence[Case] = (
    ("one-speed", "as built", GIVEN, 1.0),
    ("one-speed", "as built", LEARNED, 3.0),
    ("one-speed", "noisy percepts", GIVEN, 1.0),
    ("one-speed", "noisy percepts", LEARNED, 3.0),
)
_COMMON = ", on common starts"
_HEADER = ("controller", "seeds", "ceiling_percent", "median_percent", "worst_percent", "median_share", "worst_share",
           "median_time_ratio", "worst_time_ratio")  # fmt: skip
Times = NDArray[np.float64]


def jobs(options: Options) -> Sequence[Job]:
    """One for each case and seed."""
    return jobs_of(CASES, options)


def jobs_of(cases: Sequence[Case], options: Options) -> Sequence[Job]:
    """The jobs of some cases."""
    return [
        {
            "actions": actions,
            "robot": robot,
            "method": method,
            "minutes": options.minutes or minutes,
            "goal": options.goal,
            "seed": seed,
            "policies": options.policies,
        }
        for actions, robot, method, minutes in cases
        for seed in options.seeds_or(SEEDS)
    ]


def run(job: Job) -> Sequence[Row]:
    """Train, then drive from all starts, beside the best that this robot can do."""
    actions, name, goal = str(job["actions"]), str(job["robot"]), str(job["goal"])
    seed, minutes = int(job["seed"] or 0), float(job["minutes"] or 0.0)
    robot, task = ROBOTS[name], Task()
    problem = Problem(actions=action_set(actions, task.speed_mps, task.turn_rate_radps), goal=goal)
    began = time.process_time()
    (lesson,) = Trainee(robot, problem, Planning(method=str(job["method"])), seed).lessons((minutes,))
    core_s = time.process_time() - began
    _export(job, lesson)
    times = grid_policy_times(lesson.policy, robot, problem, protocol_starts(), np.random.default_rng([seed, 7]))
    best = ceiling_times(actions, name, goal)
    what = f"{actions}, {name}, {goal}"
    learned = Label(job_name(job), problem.plant, f"{job['method']}: {what}", seed, minutes)
    ceiling = Label(job_name(job), problem.plant, f"ceiling: {what}", seed, minutes)
    speed = 60.0 * minutes / core_s if core_s > 0.0 else None
    rows = [replace(row, robot_seconds_per_core_second=speed) for row in rows_of(learned, times, 0.0)]
    return rows + rows_of(ceiling, best, 0.0) + list(_common(learned, times, best))


def job_name(job: Job) -> str:
    """The experiment that a job belongs to."""
    if job["robot"] not in ("as built", "noisy percepts"):
        return "minutes-changed"
    return {"two-speeds": "minutes-two-speeds", "reverse": "minutes-reverse"}.get(str(job["actions"]), NAME)


@cache
def ceiling_times(actions: str, robot: str, goal: str) -> Times:
    """Docking times of the best controller on a robot, over the protocol's starts."""
    task = Task()
    job: Job = {
        "plant": "geometric",
        "actions": actions,
        "goal": goal,
        "gripper_m": GRIPPER_M,
        "speed_mps": task.speed_mps,
        "turn_rate_radps": task.turn_rate_radps * ROBOTS[robot].turn_gain,
        "delay_samples": 0,
    }
    commanded = action_set(actions, task.speed_mps, task.turn_rate_radps)
    starts = protocol_starts()
    ceiling = solve(replace(ceiling_problem(job), actions=ROBOTS[robot].actions(commanded)))
    return ceiling.time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)


def _common(label: Label, times: Times, best: Times) -> Iterator[Row]:
    """Mean times over the starts that both dock from: the learner's, and the best controller's."""
    both = np.isfinite(times) & np.isfinite(best)
    for controller, measured in ((label.controller, times), (label.controller.replace(":", " ceiling:", 1), best)):
        masked = np.where(both, measured, np.inf)
        yield rows_of(replace(label, controller=controller + _COMMON), masked, 0.0)[0]


def _export(job: Job, lesson: Lesson) -> None:
    if job["policies"] is None:
        return
    folder = Path(str(job["policies"]))
    folder.mkdir(parents=True, exist_ok=True)
    words = [job_name(job), *(str(job[key]) for key in ("method", "actions", "robot", "goal", "seed"))]
    (folder / f"{'-'.join(words).replace(' ', '_')}.policy").write_bytes(lesson.policy.to_bytes())


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """The table of shares, and the shares of the seeds as a picture."""
    name = rows[0].experiment
    table = list(shares(rows))
    path = folder / f"{name}-shares.csv"
    with write_atomically(path) as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_HEADER)
        writer.writerows([f"{x:.4g}" if isinstance(x, float) else x for x in line] for line in table)

    def paint(axes: list[Axes]) -> None:
        for place, line in enumerate(table):
            mine = _means(rows, str(line[0]))
            axes[0].plot([place] * len(mine), [row.controllable_percent for row in mine], "_", color="C0")
            axes[0].plot(place, float(line[2]), "x", color="C3")
        axes[0].set_xticks(range(len(table)), [str(line[0]) for line in table], rotation=25, ha="right", fontsize=6)
        axes[0].set(ylabel="starts that reach the goal, %", title="each seed (dash) and the ceiling (cross)")

    return [path, picture(folder / f"{name}.png", paint, columns=1, height_in=5.0)]


def shares(rows: Sequence[Row]) -> Iterator[tuple[str | int | float, ...]]:
    """One line for each case: as `_HEADER` says; shares of the ceiling, times over the ceiling's on common starts."""
    for name in dict.fromkeys(row.controller for row in rows):
        if name.startswith("ceiling") or name.endswith(_COMMON):
            continue
        percent = [row.controllable_percent for row in _means(rows, name)]
        best = _means(rows, "ceiling:" + name.split(":", 1)[1])[0].controllable_percent
        ratios = [
            (mine.docking_time_s or math.nan) / (other.docking_time_s or math.nan)
            for mine, other in zip(
                _means(rows, name + _COMMON),
                _means(rows, name.replace(":", " ceiling:", 1) + _COMMON),
                strict=True,
            )
        ]
        middle, worst = statistics.median(percent), min(percent)
        time_ratios = (statistics.median(ratios), max(ratios))
        yield (name, len(percent), best, middle, worst, middle / best, worst / best, *time_ratios)


def _means(rows: Sequence[Row], controller: str) -> list[Row]:
    """Rows over all start distances, seed by seed."""
    return sorted(select(rows, controller=controller, start_distance_m=None), key=lambda row: row.seed or 0)
