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
from docking.linear import Linear
from docking.task import Task
from experiments.evaluation import World, law_times, policy_times, score
from experiments.problem import Problem
from experiments.reach_avoid import solve
from experiments.starts import Starts, demo_starts
from runtime.params import build
from schemas.policy_pb2 import Policy

BY_HAND, BEST = (1.5, 1.5), (2.25, 1.5)
"""(k_beta, k_alpha), 1/s: tuned by hand, and the best of a grid on this plant."""


@dataclass(frozen=True)
class Comparison:
    """Shares of the starts from which the goal cell is reached, in percent."""

    starts: int
    curve: Sequence[tuple[float, float]]
    """(robot minutes, percent) of the frozen policy."""
    rows: Sequence[Sequence[str]]
    """Table with its head first."""
    ceiling_percent: float


def compare(policies: Sequence[tuple[float, Policy]], task_table: Mapping[str, Any]) -> Comparison:
    """Evaluate policies sampled over a session.

    Args:
        policies: (robot seconds, policy), in order; at least one.
        task_table: the session's task.
    """
    task = build(Task, task_table, "task")
    world, starts = World(task), demo_starts()
    teacher = Linear(*BEST, task.turn_rate_radps)
    times = [policy_times(world, table_of(policy), starts, teacher) for _, policy in policies]
    curve = [(at_s / 60, score(own).controllable_percent) for (at_s, _), own in zip(policies, times, strict=True)]
    best_s = _fastest(task, starts)
    rows = [["", "goal cell reached, %", "share of what is possible, %", "mean time, s"]]
    for name, own in (
        ("the last policy learned", times[-1]),
        ("linear law, tuned by hand", law_times(world, Linear(*BY_HAND, task.turn_rate_radps), starts)),
        ("linear law, best of a grid", law_times(world, teacher, starts)),
        ("best that is possible", best_s),
    ):
        rows.append(_row(name, own, best_s))
    return Comparison(len(starts), curve, rows, score(best_s).controllable_percent)


def _fastest(task: Task, starts: Starts) -> NDArray[np.float64]:
    return solve(Problem(task=task, actions=task.actions)).time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)


def _row(name: str, times_s: NDArray[np.float64], best_s: NDArray[np.float64]) -> list[str]:
    own, best = score(times_s), score(best_s)
    share = 100 * own.controllable_percent / best.controllable_percent if best.controllable_percent else 0.0
    mean = "-" if own.docking_time_s is None else f"{own.docking_time_s:.1f}"
    return [name, f"{own.controllable_percent:.1f}", f"{share:.1f}", mean]
