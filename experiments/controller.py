"""Driving the plant with any controller, from many starts at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from docking.levels import judge
from experiments.problem import Floats, Problem
from experiments.rollout import step
from experiments.starts import Starts

Controller = Callable[[Floats, Floats, Floats], tuple[Floats, Floats]]
"""(beta_rad, alpha_rad, d_m), `[N]` each, to (v_mps, omega_radps), `[N]` each."""

LIMIT_S = 100.0
"""A robot that has not arrived by then does not."""


def points_of(beta_rad: ArrayLike, alpha_rad: ArrayLike, d_m: ArrayLike) -> Floats:
    """States as one array `[N, 3]`; single numbers are repeated."""
    columns = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (beta_rad, alpha_rad, d_m)))
    return np.stack([column.ravel() for column in columns], axis=1)


@njit(nogil=True, cache=True)
def stepped(printed: bool, points: Floats, commands: Floats, dt: float) -> Floats:
    """States [N, 3] one sampling period later, under commands [N, 2] (m/s, rad/s)."""
    after = np.empty_like(points)
    for n in range(len(points)):
        beta, alpha, d = points[n]
        after[n] = step(printed, beta, alpha, d, commands[n, 0], commands[n, 1], dt)
    return after


class Robots:
    """Many robots that one controller drives, one sampling period at a time.

    With a delay the robots stand until the first command arrives. A controller that `predicts` is asked about the
    state in which its command will be executed, else about the one that was seen.
    """

    def __init__(self, controller: Controller, starts: Starts, problem: Problem, *, predicts: bool = True) -> None:
        self.points = points_of(starts.beta_rad, starts.alpha_rad, starts.d_m)
        """States `[N, 3]`."""
        self._controller, self._problem, self._predicts = controller, problem, predicts
        self._queue: list[Floats] = [np.zeros((len(self.points), 2))] * problem.delay_samples

    def keep(self, kept: NDArray[np.bool_]) -> None:
        """Forget the other robots."""
        self.points, self._queue = self.points[kept], [commands[kept] for commands in self._queue]

    def advance(self) -> None:
        """One sampling period."""
        printed, dt = self._problem.printed, self._problem.sampling_s
        seen = self.points
        for commands in self._queue if self._predicts else ():
            seen = stepped(printed, seen, commands, dt)
        self._queue.append(np.stack(self._controller(*seen.T), axis=1))
        self.points = stepped(printed, self.points, self._queue.pop(0), dt)


def docking_times(controller: Controller, starts: Starts, problem: Problem, *, predicts: bool = True) -> Floats:
    """Time to the goal from each start, `[N]` s; inf where the sink or LIMIT_S comes first."""
    robots = Robots(controller, starts, problem, predicts=predicts)
    times, driving = np.full(len(starts), np.inf), np.arange(len(starts))
    for sample in range(round(LIMIT_S / problem.sampling_s) + 1):
        verdicts = judge(problem.limits, robots.points)
        times[driving[verdicts == 1]] = sample * problem.sampling_s
        robots.keep(verdicts == 0)
        driving = driving[verdicts == 0]
        if not len(driving):
            break
        robots.advance()
    return times


def trace(controller: Controller, starts: Starts, problem: Problem) -> list[Floats]:
    """States `[samples, 3]` of each start, from the start to goal, sink or LIMIT_S."""
    robots = Robots(controller, starts, problem)
    states = [robots.points]
    for _ in range(round(LIMIT_S / problem.sampling_s)):
        robots.advance()
        states.append(robots.points)
        if (judge(problem.limits, robots.points) != 0).all():
            break
    paths = np.stack(states, axis=1)
    verdicts = np.stack([judge(problem.limits, points) for points in states], axis=1)
    ends = [int(line.argmax()) + 1 if line.any() else line.size for line in verdicts != 0]
    return [path[:end] for path, end in zip(paths, ends, strict=True)]
