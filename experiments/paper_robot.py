"""What the actions of the paper's own robot can reach on the true plant: the ceiling of `launch/paper-robot.toml`.

The paper counts d from the gripper, 0.2 to 0.95 m (tilt 43 to 20 deg); the sink is nearer, and outside the ranges.
"""

from __future__ import annotations

import time
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from docking.angles import DEG
from docking.levels import Limits
from docking.task import Task
from experiments.campaign import Job, Options
from experiments.problem import GRIPPER_M, Problem
from experiments.reach_avoid import solve
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import protocol_starts
from runtime.params import build

NAME = "paper-robot"
LAUNCH = Path(__file__).parents[1] / "launch" / "paper-robot.toml"
DISTANCES_M = tuple(round(d + GRIPPER_M, 3) for d in (0.65, 0.8, 0.95))
"""From the axle."""
_NEAREST_M = 0.2 + GRIPPER_M
_ROOM_M = 0.02
"""Beyond the farthest start, so that it is not in the sink itself."""
_BLUR_RAD = 1.25 * DEG


def task() -> Task:
    """Of the launch file."""
    return build(Task, tomllib.loads(LAUNCH.read_text(encoding="utf-8"))["task"], f"{LAUNCH.name}: task")


@dataclass(frozen=True)
class PaperRobot(Problem):
    """The problem between the paper's distances."""

    task: Task = field(default_factory=task)

    @property
    def d_max_m(self) -> float:
        """Farther than this is the sink."""
        return max(DISTANCES_M) + _ROOM_M

    @property
    def limits(self) -> Limits:
        """Goal and sink."""
        return super().limits._replace(d_min_m=_NEAREST_M)


def jobs(options: Options) -> Sequence[Job]:
    """One for each goal cell: the paper's, and one as fine as its simulation's."""
    del options  # the launch file says everything
    own = task()
    return [{"speed_mps": own.speed_mps, "turn_rate_radps": own.turn_rate_radps, "cells": n} for n in (15, 31)]


def run(job: Job) -> Sequence[Row]:
    """Solve, drive, count."""
    began = time.process_time()
    own = Task(
        speed_mps=float(job["speed_mps"] or 0.0),
        turn_rate_radps=float(job["turn_rate_radps"] or 0.0),
        beta_cells=int(job["cells"] or 0),
        alpha_cells=int(job["cells"] or 0),
    )
    backup = max(1, round(_BLUR_RAD / (own.turn_rate_radps * Problem().sampling_s)))
    problem = PaperRobot(task=own, actions=own.actions, backup_samples=backup)
    starts = protocol_starts(own, DISTANCES_M)
    times = solve(problem).time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)
    label = Label(NAME, problem.plant, f"ceiling, goal cell of {own.beta_cells} driven")
    return rows_of(label, times, time.process_time() - began, DISTANCES_M)


def draw(rows: Sequence[Row], folder: Path) -> Sequence[Path]:
    """Nothing: three numbers need no picture."""
    del rows, folder
    return []
