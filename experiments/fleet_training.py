"""Robots that were built alike and differ a little, and learn in common: what one has seen, all know."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from components.learner.perceptual import Planning
from docking.grid_policy import GridPolicy
from experiments.minutes_training import Trainee
from experiments.problem import Problem
from experiments.robot import HEAD_BEHIND_S, Robot

SPREAD = 0.1
"""Robots differ by up to this share."""
SEED = 6
"""Of the four robots of `launch/fleet.toml`."""
ROBOTS = 4


class Build(NamedTuple):
    """By how much one robot differs from the drawing: factors."""

    speed: float
    """Of its wheels' size: speed executed for the speed commanded."""
    turn: float
    """Of its track: turn rate executed for the turn rate commanded."""
    height: float
    """Of the camera over the object."""
    focal: float
    """Of the lens."""

    def robot(self, noise: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Robot:
        """For the experiments without images.

        The height is left out: it cancels, since distances are counted in that of the pick-up, which each was shown.
        """
        return Robot(speed_gain=self.speed, turn_gain=self.turn, lead_s=(self.focal - 1.0) * HEAD_BEHIND_S, noise=noise)


def drawn(count: int = ROBOTS, seed: int = SEED) -> tuple[Build, ...]:
    """Robots whose factors are drawn evenly, rounded to a thousandth as a launch file has them."""
    factors = np.random.default_rng(seed).uniform(1.0 - SPREAD, 1.0 + SPREAD, (count, len(Build._fields)))
    return tuple(Build(*row) for row in factors.round(3).tolist())


class Fleet:
    """Robots that train at the same time, one sample each in turn, and learn in common. One robot is a fleet, too."""

    def __init__(self, robots: Sequence[Robot], problem: Problem, planning: Planning, seed: int) -> None:
        first = Trainee(robots[0], problem, planning, seed)
        others = [
            Trainee(robot, problem, planning, seed, number, first.learner)
            for number, robot in enumerate(robots[1:], start=1)
        ]
        self.trainees = (first, *others)
        self.sampling_s = problem.sampling_s

    def policies(self, minutes: Sequence[float]) -> Iterator[tuple[float, list[GridPolicy | None]]]:
        """Train; at each of these times (increasing), of all robots together, the time and what each knows then.

        Robots that share learn in the middle of a way, too, and drive on by what they have learned.
        """
        first = self.trainees[0]
        for stop in minutes:
            while first.samples * self.sampling_s * len(self.trainees) < 60.0 * stop:
                for trainee in self.trainees:
                    if trainee.sample() and len(self.trainees) > 1:
                        trainee.take_plan()
            for trainee in self.trainees:
                trainee.finish_plan()
            yield stop, [trainee.learner.policy() for trainee in self.trainees]
