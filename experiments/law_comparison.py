"""The smooth docking law on the protocol's starts and limits, beside the linear law and the ceiling.

It is given what no other controller here has: the true metric pose. Its target is the object itself, or the pose from
which the gripper takes the object; it drives at constant speed, or slows down by its own rule.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes

from docking.linear import BEST_TUNED, Linear
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.controller import Controller, docking_times
from experiments.docking_law import DockingLaw
from experiments.laws import docking, linear
from experiments.picture import picture
from experiments.problem import GRIPPER_M, Problem, action_set
from experiments.reach_avoid import solve
from experiments.rows import Row, select
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts

NAME = "docking-law"
_CEILING, _LINEAR = "ceiling", "LC, best-tuned"
_TARGETS = ("object", "pose")
_SPEEDS = ("constant speed", "own speed rule")
_LAWS = tuple(f"docking law, {speed}, towards the {target}" for target in _TARGETS for speed in _SPEEDS)


def jobs(options: Options) -> Sequence[Job]:
    """One for each controller."""
    task = Task()
    return [
        {
            "controller": controller,
            "goal": options.goal,
            "gripper_m": options.gripper_m or GRIPPER_M,
            "speed_mps": options.speed_mps or task.speed_mps,
            "turn_rate_radps": options.turn_rate_radps or task.turn_rate_radps,
            "delay_samples": options.delay_samples,
        }
        for controller in (_CEILING, _LINEAR, *_LAWS)
    ]


def run(job: Job) -> Sequence[Row]:
    """Drive from all starts."""
    speed, turn_rate = float(job["speed_mps"] or 0.0), float(job["turn_rate_radps"] or 0.0)
    problem = Problem(
        actions=action_set("one-speed", speed, turn_rate),
        goal=str(job["goal"]),
        gripper_m=float(job["gripper_m"] or 0.0),
        delay_samples=int(job["delay_samples"] or 0),
    )
    began = time.process_time()
    times = docking_times(_controller(str(job["controller"]), problem), protocol_starts(), problem)
    label = Label(NAME, problem.plant, f"{job['controller']} ({problem.goal})")
    return rows_of(label, times, time.process_time() - began)


def _controller(name: str, problem: Problem) -> Controller:
    speed, turn_rate = problem.actions[0]
    if name == _CEILING:
        return solve(problem).act
    if name == _LINEAR:
        return linear(Linear(*BEST_TUNED, turn_rate), speed)
    law = DockingLaw(speed_max_mps=speed, turn_rate_max_radps=turn_rate, constant_speed="constant" in name)
    return docking(law, problem.gripper_m if name.endswith("pose") else 0.0)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Share and docking time against the start distance."""

    def paint(axes: list[Axes]) -> None:
        share, duration = axes
        for i, name in enumerate(dict.fromkeys(row.controller for row in rows)):
            line = [row for row in select(rows, controller=name) if row.start_distance_m is not None]
            x = [row.start_distance_m or math.nan for row in line]
            style = "--" if "constant" in name else "-"
            share.plot(x, [row.controllable_percent for row in line], style, marker=".", color=f"C{i}", label=name)
            duration.plot(x, [row.docking_time_s or math.nan for row in line], style, marker=".", color=f"C{i}")
        share.set(xlabel="start distance, m", ylabel="starts that reach the goal, %", ylim=(0, 102))
        duration.set(xlabel="start distance, m", ylabel="mean docking time, s", ylim=(0, None))
        share.figure.legend(loc="outside lower center", ncols=2)

    return [picture(folder / "docking-law.png", paint, columns=2, height_in=5.0)]
