"""Learned live in 5 robot-minutes by the learner of our own, then frozen: whole system, camera, all disturbances.

All seeds and action sets begin at the same starts (paired), over all of the task's ranges. One speed is judged
by the share of its docked ceiling (ideal motors, no delay, the task's ranges as walls), the others by all starts.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

from benchmarks.evaluation import learned_policy
from benchmarks.figure import Figure
from benchmarks.trials import evaluate
from docking.actions import ACTION_SETS
from docking.score import Trial, brier
from docking.starts import start
from docking.task import Task
from experiments.problem import Problem, action_set
from experiments.reach_avoid import solve

TRAIN_S = 300.0
STARTS = 500
SEEDS = (1, 2, 3)
METHODS = ("structure-given", "structure-learned")
ASKED = {"one-speed": 90.0, "two-speeds": 85.0, "reverse": 97.0}
"""% of its starts that a set of actions shall dock from."""
FENCE = "base.fence_m=1000"
"""The fence is the odometry's, which placing a robot does not tell."""


def figures(methods: Sequence[str] = METHODS, starts: int = STARTS, seeds: Sequence[int] = SEEDS) -> list[Figure]:
    """Every method and set of actions, each seed."""
    return [
        figure
        for method in methods
        for actions in ACTION_SETS
        for figure in _rows(method, actions, starts, [_trials(method, actions, seed, starts) for seed in seeds])
    ]


def _trials(method: str, actions: str, seed: int, starts: int) -> list[Trial]:
    world = (f"task.action_set={actions}", "simulator.starts=full", FENCE)
    ours = (f"learner.method={method}", "pilot.controller=greedy")
    policy = learned_policy(TRAIN_S, seed, (*world, *ours))
    return evaluate((*world, f"pilot.policy={policy}"), 0, starts)


def _rows(method: str, actions: str, starts: int, runs: Sequence[Sequence[Trial]]) -> list[Figure]:
    name = f"{method}, {actions}"
    judged = reachable(actions, starts) if actions == "one-speed" else np.ones(starts, dtype=bool)
    trials = [trial for run in runs for trial in run]
    counted = [trial for run in runs for trial, counts in zip(run, judged, strict=True) if counts]
    docked = sum(trial.docked for trial in counted)
    asked = ASKED[actions] if method == METHODS[0] else None
    low, high = binomtest(docked, max(len(counted), 1)).proportion_ci(method="wilson")
    note = f"{docked} of {len(counted)}, {100 * low:.1f} to {100 * high:.1f}; by seed {_by_seed(runs)} of all"
    times_s = [trial.duration_s for trial in trials if trial.docked]
    square, told = brier(trials)
    base = np.mean([trial.docked for trial in trials])
    return [
        Figure(f"{name}: docked", 100 * docked / max(len(counted), 1), "%", at_least=asked, note=note),
        Figure(f"{name}: collided", sum(t.collided for t in trials), "trials", at_most=0.0 if asked else None),
        Figure(f"{name}: mean time to the pick-up", float(np.mean(times_s)) if times_s else np.nan, "s"),
        Figure(f"{name}: Brier score", square, note=f"{told} forecasts; the mean alone {base * (1 - base):.3f}"),
    ]


def _by_seed(runs: Sequence[Sequence[Trial]]) -> str:
    return ", ".join(f"{100 * sum(trial.docked for trial in run) / max(len(run), 1):.1f} %" for run in runs)


def reachable(actions: str, starts: int) -> NDArray[np.bool_]:
    """From which starts the best feedback docks, `[starts]`."""
    rows = np.array([start("full", 2005, number, Task()) for number in range(starts)])
    task = Task()
    problem = Problem(goal="dock", actions=action_set(actions, task.speed_mps, task.turn_rate_radps))
    return solve(problem).reachable(*rows.T)


def main() -> None:
    """`python -m benchmarks.minutes_live METHOD STARTS SEED...`: a part of it."""
    for figure in figures([sys.argv[1]], int(sys.argv[2]), [int(seed) for seed in sys.argv[3:]] or SEEDS):
        sys.stdout.write(f"{figure.name}: {figure.value:.3f} {figure.unit} {figure.rule} ({figure.note})\n")


if __name__ == "__main__":
    main()
