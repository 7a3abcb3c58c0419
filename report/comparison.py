"""The session's policies beside linear laws and the best that is possible, on the bare plant from the same starts.

No camera, no noise, no latency: the plant of `docking.plant` alone, so that it takes a second. `make bench` compares
with the camera in the loop.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.pilot.messages import table_of
from docking.angles import DEG
from docking.linear import BEST_TUNED, HAND_TUNED, Linear
from docking.policy import PolicyTable
from docking.task import Task
from experiments.controller import docking_times
from experiments.evaluation import World, law_times, policy_times, score
from experiments.problem import Problem
from experiments.reach_avoid import solve
from experiments.starts import Starts, demo_starts
from report.shadow import task_of
from schemas.policy_pb2 import Policy

Floats = NDArray[np.float64]
_MOST, _MOST_FINE = 24, 10
"""Policies evaluated; those that know the distance take longer."""
_STEP_RAD, _STEP_M, _BACKUP_SAMPLES = 1.0 * DEG, 0.02, 2
"""How finely the best is computed: ten times as fast as `Problem`'s own steps, and 0.2 points lower."""


@dataclass(frozen=True)
class Comparison:
    """Shares of the starts from which the goal cell is reached, in percent."""

    starts: int
    curve: Sequence[tuple[float, float]]
    """(robot minutes, percent) of the frozen policy with the teacher where it knows nothing: as the pilot drives."""
    alone: Sequence[tuple[float, float]]
    """As above, of the policy alone: where it knows nothing, the last action goes on (or straight on)."""
    rows: Sequence[Sequence[str]]
    """Table with its head first."""
    ceiling_percent: float


def compare(
    policies: Sequence[tuple[float, Policy]], task_table: Mapping[str, Any], camera_height_m: float = 0.45
) -> Comparison:
    """Evaluate policies sampled over a session.

    Args:
        policies: (robot seconds, policy), in order; at least one.
        task_table: the session's task.
        camera_height_m: above the object; policies that know the distance count in camera heights.
    """
    task = task_of({"task": task_table})
    world, starts = World(task), demo_starts()
    teacher = Linear(*BEST_TUNED, task.turn_rate_radps)
    tables = [(at_s / 60, table_of(policy)) for at_s, policy in _spread(policies)]
    alone, driven = (
        [(at_min, _times(world, table, starts, law, camera_height_m)) for at_min, table in tables]
        for law in (None, teacher)
    )
    best_s = _fastest(task, starts)
    rows = [["", "reach the goal, %", "of possible, %", "mean, s"]]
    for name, own in (
        ("policy learned, alone", alone[-1][1]),
        ("with the teacher", driven[-1][1]),
        ("law tuned by hand", law_times(world, Linear(*HAND_TUNED, task.turn_rate_radps), starts)),
        ("best law of a grid", law_times(world, teacher, starts)),
        ("best possible", best_s),
    ):
        rows.append(_row(name, own, best_s))
    return Comparison(len(starts), _curve(driven), _curve(alone), rows, score(best_s).controllable_percent)


def _spread(policies: Sequence[tuple[float, Policy]]) -> list[tuple[float, Policy]]:
    """So many that a page takes no time, the first and the last among them."""
    most = _MOST_FINE if policies[-1][1].HasField("fine") else _MOST
    places = np.unique(np.linspace(0, len(policies) - 1, min(most, len(policies))).round().astype(int))
    return [policies[place] for place in places.tolist()]


def _times(
    world: World, table: PolicyTable, starts: Starts, law: Linear | None, camera_height_m: float
) -> NDArray[np.float64]:
    if table.fine is None:
        return policy_times(world, table, starts, law)
    fine, actions = table.fine, np.array(table.actions)
    straight = Linear(0.0, 0.0, world.task.turn_rate_radps) if law is None else law

    def act(beta_rad: Floats, alpha_rad: Floats, d_m: Floats) -> tuple[Floats, Floats]:
        chosen = fine.act(np.stack([beta_rad, alpha_rad, np.log(d_m / camera_height_m)], axis=1))
        wanted = np.array([straight.omega_radps(b, a) for b, a in zip(beta_rad, alpha_rad, strict=True)])
        known = chosen >= 0
        speed = np.where(known, actions[chosen, 0], world.task.speed_mps)
        return speed, np.where(known, actions[chosen, 1], wanted)

    return docking_times(act, starts, Problem(task=world.task, actions=world.task.actions))


def _curve(times: Sequence[tuple[float, NDArray[np.float64]]]) -> list[tuple[float, float]]:
    return [(at_min, score(own_s).controllable_percent) for at_min, own_s in times]


def _fastest(task: Task, starts: Starts) -> NDArray[np.float64]:
    problem = Problem(
        task=task,
        actions=task.actions,
        angle_step_rad=_STEP_RAD,
        distance_step_m=_STEP_M,
        backup_samples=_BACKUP_SAMPLES,
    )
    return solve(problem).time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)


def _row(name: str, times_s: NDArray[np.float64], best_s: NDArray[np.float64]) -> list[str]:
    own, best = score(times_s), score(best_s)
    share = 100 * own.controllable_percent / best.controllable_percent if best.controllable_percent else 0.0
    mean = "-" if own.docking_time_s is None else f"{own.docking_time_s:.1f}"
    return [name, f"{own.controllable_percent:.1f}", f"{share:.1f}", mean]
