"""How much of the task can be reached at all, and how fast, by the best controller that physics allows.

Controllers named `* driven` are the fastest policy, driven over the starts: what they reach is reached. `* level set`
is the reach-avoid set without driving; it has no docking time.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from docking.angles import DEG
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.controller import docking_times
from experiments.picture import picture
from experiments.problem import GRIPPER_M, Problem, action_set
from experiments.reach_avoid import solve
from experiments.rows import Row, select
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts

NAME = "ceiling"
_CASES = (("geometric", "one-speed"), ("geometric", "two-speeds"), ("geometric", "reverse"), ("printed", "one-speed"))
_FINE, _REVERSE, _REVERSE_DOCK = (0.5 * DEG, 0.01), (1.0 * DEG, 0.0125), (1.0 * DEG, 0.008)
"""Steps of the nodes. Reversing settles slowly and loses nothing on coarse ones; beside the gripper's goal, where it
can shuttle for ever on a blurred value, they are finer in d."""
_BLUR_RAD = 1.25 * DEG
"""A backup should turn the robot at least so far, or interpolation blurs the edge."""


def jobs(options: Options) -> Sequence[Job]:
    """One for each plant and action set."""
    return [
        {
            "plant": plant,
            "actions": actions,
            "goal": options.goal,
            "gripper_m": options.gripper_m or GRIPPER_M,
            "speed_mps": options.speed_mps or Task().speed_mps,
            "turn_rate_radps": options.turn_rate_radps or Task().turn_rate_radps,
            "delay_samples": options.delay_samples,
        }
        for plant, actions in _CASES
    ]


def problem_of(job: Job) -> Problem:
    """The problem of a job."""
    turn_rate = float(job["turn_rate_radps"] or 0.0)
    reverse_steps = _REVERSE_DOCK if job["goal"] == "dock" else _REVERSE
    angle_step, distance_step = reverse_steps if job["actions"] == "reverse" else _FINE
    sampled = Problem()
    return Problem(
        plant=str(job["plant"]),
        actions=action_set(str(job["actions"]), float(job["speed_mps"] or 0.0), turn_rate),
        goal=str(job["goal"]),
        gripper_m=float(job["gripper_m"] or 0.0),
        delay_samples=int(job["delay_samples"] or 0),
        angle_step_rad=angle_step,
        distance_step_m=distance_step,
        backup_samples=max(1, round(_BLUR_RAD / (turn_rate * sampled.sampling_s))),
    )


def run(job: Job) -> Sequence[Row]:
    """Solve, drive, count."""
    began = time.process_time()
    problem, starts, name = problem_of(job), protocol_starts(), name_of(job)
    ceiling = solve(problem, levels=True)
    states = (starts.beta_rad, starts.alpha_rad, starts.d_m)
    measured = {f"{name} driven": ceiling.time_s(*states)}
    if problem.delay_samples:
        blind = docking_times(ceiling.act, starts, problem, predicts=False)
        measured[f"{name} driven without prediction"] = blind
    core_s = time.process_time() - began
    rows = [
        row
        for controller, times in measured.items()
        for row in rows_of(Label(NAME, problem.plant, controller), times, core_s)
    ]
    level_times = np.where(ceiling.level(*states) <= 0.0, 0.0, np.inf)
    level_rows = rows_of(Label(NAME, problem.plant, f"{name} level set"), level_times, core_s)
    return rows + [replace(row, docking_time_s=None, robot_seconds_per_core_second=None) for row in level_rows]


def name_of(job: Job) -> str:
    """Controller column: action set, goal, and what is unlike the paper's."""
    task = Task()
    turn_rate, speed = float(job["turn_rate_radps"] or 0.0), float(job["speed_mps"] or 0.0)
    words = [str(job["actions"]), f"dock {job['gripper_m']:g} m" if job["goal"] == "dock" else "cell"]
    if turn_rate != task.turn_rate_radps:
        words.append(f"{turn_rate / DEG:g} deg/s")
    if speed != task.speed_mps:
        words.append(f"{speed:g} m/s")
    if job["delay_samples"]:
        words.append(f"delay {job['delay_samples']}")
    return " ".join(words)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Share and docking time against the start distance."""

    def paint(axes: list[Axes]) -> None:
        share, duration = axes
        for plant, name in dict.fromkeys((row.plant, row.controller) for row in rows):
            line = [row for row in select(rows, plant=plant, controller=name) if row.start_distance_m is not None]
            x = [row.start_distance_m or math.nan for row in line]
            style = ":" if name.endswith("level set") else "--" if plant == "printed" else "-"
            label = None if style == ":" else f"{plant}: {name}"
            colour = f"C{_colour(plant, name)}"
            share.plot(x, [row.controllable_percent for row in line], style, marker=".", color=colour, label=label)
            if style != ":":
                duration.plot(x, [row.docking_time_s or math.nan for row in line], style, marker=".", color=colour)
        share.set(xlabel="start distance, m", ylabel="starts that reach the goal, %", ylim=(0, 102))
        duration.set(xlabel="start distance, m", ylabel="mean docking time, s", ylim=(0, None))
        share.set_title("driven (lines) and level set (dots)")
        share.legend(loc="lower right")

    return [picture(folder / "ceiling.png", paint, columns=2)]


def _colour(plant: str, name: str) -> int:
    return next(i for i, case in enumerate(_CASES) if case[0] == plant and name.startswith(case[1]))
