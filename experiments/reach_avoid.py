"""The ceiling: from which states the goal can be reached at all, how fast, and by which policy.

    ceiling = solve(Problem())
    ceiling.reachable(beta_rad, alpha_rad, d_m)      # [N] bool
    ceiling.time_s(beta_rad, alpha_rad, d_m)         # [N] s, inf where the goal is not reached
    ceiling.act(beta_rad, alpha_rad, d_m)            # [N] v_mps, [N] omega_radps

`reachable` and `time_s` drive the plant with the computed policy, so what they call reachable is reached: a lower bound
of the true ceiling. The level set is a second estimate, without driving; the two agree within about a point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from docking.levels import FAR
from docking.value_iteration import LATE_S, look_up, promises, sweep
from experiments.controller import docking_times, points_of
from experiments.problem import Floats, Problem
from experiments.rollout import landings_of, moves_of
from experiments.starts import Starts

_SWEEPS = 400
_SETTLED = 0.01
"""Sweeps end when no node changes by more: seconds, or hundredths of the goal's size."""


@dataclass(frozen=True, eq=False)
class Ceiling:
    """A solved problem."""

    problem: Problem
    times_s: Floats
    """[d nodes, alpha nodes, beta nodes] least time to the goal, LATE_S where there is none."""
    levels: Floats | None
    """Same shape: at most 0 where the goal can be reached; None if it was not asked for."""

    def act(self, beta_rad: Floats, alpha_rad: Floats, d_m: Floats) -> tuple[Floats, Floats]:
        """Speed (m/s) and turn rate (rad/s) of the fastest policy at each state, `[N]`."""
        problem, actions = self.problem, np.array(self.problem.actions)
        landings = landings_of(problem.printed, points_of(beta_rad, alpha_rad, d_m), actions, problem.sampling_s)
        chosen = promises(self.times_s, problem.nodes, problem.limits, landings, problem.sampling_s).argmin(axis=1)
        return actions[chosen, 0], actions[chosen, 1]

    def time_s(self, beta_rad: ArrayLike, alpha_rad: ArrayLike, d_m: ArrayLike) -> Floats:
        """Docking time of the fastest policy, driven, from each state `[N]`; inf where it does not reach the goal."""
        return docking_times(self.act, Starts(*points_of(beta_rad, alpha_rad, d_m).T), self.problem)

    def reachable(self, beta_rad: ArrayLike, alpha_rad: ArrayLike, d_m: ArrayLike) -> NDArray[np.bool_]:
        """Does the fastest policy reach the goal from each state `[N]`?"""
        return np.isfinite(self.time_s(beta_rad, alpha_rad, d_m))

    def level(self, beta_rad: ArrayLike, alpha_rad: ArrayLike, d_m: ArrayLike) -> Floats:
        """Interpolated level `[N]`, without delay; at most 0 where the goal can be reached.

        Raises:
            ValueError: the problem was solved without levels.
        """
        if self.levels is None:
            raise ValueError("solve(problem, levels=True) computes levels")
        found: Floats = look_up(self.levels, self.problem.nodes, points_of(beta_rad, alpha_rad, d_m))
        return found

    def value_s(self, beta_rad: ArrayLike, alpha_rad: ArrayLike, d_m: ArrayLike) -> Floats:
        """Interpolated least time `[N]`, without driving; blurred near the edge of what is reachable."""
        found: Floats = look_up(self.times_s, self.problem.nodes, points_of(beta_rad, alpha_rad, d_m))
        return found


def solve(problem: Problem, *, levels: bool = False) -> Ceiling:
    """The ceiling of a problem; `levels` computes the level set too.

    Raises:
        RuntimeError: the values do not settle.
    """
    return Ceiling(problem, _values(problem, timed=True), _values(problem, timed=False) if levels else None)


def _values(problem: Problem, *, timed: bool) -> Floats:
    beta, alpha, d = problem.nodes
    dt = problem.sampling_s * problem.backup_samples
    moves = moves_of(problem.printed, alpha, d, np.array(problem.actions), dt)
    durations = np.full(len(problem.actions), dt)
    value = np.full((len(d), len(alpha), len(beta)), LATE_S if timed else FAR)
    forwards = all(v > 0.0 for v, _ in problem.actions)
    passes = 60 if forwards else 2  # driving forwards a distance depends on nearer ones only: settle it before the next
    for _ in range(_SWEEPS):
        if sweep(value, moves, problem.nodes, problem.limits, timed, durations, passes, 0.1 * _SETTLED) < _SETTLED:
            return value
    raise RuntimeError(f"values have not settled after {_SWEEPS} sweeps; larger backup_samples help: {problem}")
