"""The frozen policy after 40 robot-minutes of the paper's RL-LC, camera in the loop, beside linear controllers.

All start from the same 500 seeded places (paired), and see them through the same rendered camera. The best-tuned law is
the best of a grid, tuned on other starts in the same world.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

from benchmarks.figure import Figure
from benchmarks.trials import LAUNCH, evaluate, policy_file, watched
from components.pilot.messages import table_of
from docking.score import Trial
from experiments.problem import Problem
from experiments.reach_avoid import solve
from experiments.starts import demo_starts
from runtime.launch import load
from runtime.lockstep import Lockstep

TRAIN_S = 2400.0
STARTS = 500
TUNING_FIRST, TUNING_STARTS = 10_000, 40
GRID = tuple((ratio * k_alpha, k_alpha) for ratio in (1.25, 1.5, 1.75, 2.0, 2.25) for k_alpha in (1.0, 1.5, 2.0))
"""(k_beta, k_alpha), 1/s, of the search for the best-tuned law; their ratio is what matters."""
BY_HAND = (1.5, 1.5)


def figures() -> list[Figure]:
    """Train, tune, evaluate, compare."""
    policy = learned_policy(TRAIN_S)
    best = tuned_law()
    trials = {
        "learned": evaluate((f"pilot.policy={policy}",), 0, STARTS),
        "linear, by hand": evaluate(_law(*BY_HAND), 0, STARTS),
        "linear, best": evaluate(_law(*best), 0, STARTS),
    }
    found = [Figure("best gains", best[0], "1/s on beta", note=f"and {best[1]:g} 1/s on alpha")]
    reachable = {goal: reachable_starts(goal) for goal in ("cell", "dock")}
    for name, own in trials.items():
        found += _scores(name, own, reachable)
    for name in ("linear, by hand", "linear, best"):
        found.append(mcnemar(name, trials["learned"], trials[name]))
    return found


def learned_policy(train_s: float, seed: int = 1, overrides: Sequence[str] = ()) -> str:
    """Learn in one process; path of the frozen policy."""
    system = load(LAUNCH, [f"pilot.train_s={train_s}", "pilot.evaluation_trials=0", *overrides], seed=seed)
    engine = Lockstep(system)
    policies: deque[Any] = deque(maxlen=1)
    engine.watch("learner/policy", lambda message, _: policies.append(message))
    watched(engine)
    return policy_file(table_of(policies[-1]).to_bytes())


def tuned_law() -> tuple[float, float]:
    """Gains of the grid that dock from most of the tuning starts; of two equal ones those that reach more."""
    scores = {gains: evaluate((*_law(*gains), "pilot.pick_up=false"), TUNING_FIRST, TUNING_STARTS) for gains in GRID}
    return max(scores, key=lambda gains: sum(trial.reached for trial in scores[gains]))


def _law(k_beta_per_s: float, k_alpha_per_s: float) -> tuple[str, ...]:
    gains = (f"pilot.k_beta_per_s={k_beta_per_s}", f"pilot.k_alpha_per_s={k_alpha_per_s}")
    return ("pilot.evaluation_controller=lc", *gains)


def reachable_starts(goal: str) -> NDArray[np.bool_]:
    """From which starts the best feedback reaches the paper's goal cell, or docks."""
    starts = demo_starts(STARTS)
    return solve(Problem(goal=goal)).reachable(starts.beta_rad, starts.alpha_rad, starts.d_m)


def _scores(name: str, trials: Sequence[Trial], reachable: dict[str, NDArray[np.bool_]]) -> list[Figure]:
    count = len(trials)
    times = [trial.duration_s for trial in trials if trial.docked]
    rows = (
        ("reached", sum(t.reached for t in trials), reachable["cell"].sum()),
        ("docked", sum(t.docked for t in trials), reachable["dock"].sum()),
        ("picked", sum(t.picked for t in trials), reachable["dock"].sum()),
        ("collided", sum(t.collided for t in trials), None),
    )
    found = [
        Figure(f"{name}: {word}", 100 * n / count, "%", note=f"{n} of {count}" + _share(n, of)) for word, n, of in rows
    ]
    return [*found, Figure(f"{name}: mean time of a docking", float(np.mean(times)) if times else np.nan, "s")]


def _share(n: int, of: int | None) -> str:
    return "" if of is None else f"; {100 * n / of:.1f} % of the {of} reachable"


def mcnemar(name: str, ours: Sequence[Trial], theirs: Sequence[Trial]) -> Figure:
    """Exact McNemar test on docked or not, start by start."""
    won = sum(a.docked and not b.docked for a, b in zip(ours, theirs, strict=True))
    lost = sum(b.docked and not a.docked for a, b in zip(ours, theirs, strict=True))
    p = binomtest(won, won + lost).pvalue if won + lost else 1.0
    return Figure(f"McNemar, learned against {name}", p, "p", note=f"only learned {won}, only {name} {lost}")
