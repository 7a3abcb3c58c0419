"""Driving a learned grid policy from many starts, on the robot it was learned on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from docking.grid_policy import GridPolicy
from docking.levels import judge
from experiments.controller import LIMIT_S, points_of
from experiments.minutes_training import Chooser, law_of
from experiments.problem import Problem
from experiments.robot import Drivetrain, Robot, poses_of, states_of
from experiments.starts import Starts

Floats = NDArray[np.float64]


class Driven(NamedTuple):
    """Robots that are still driving, at one sample."""

    robots: NDArray[np.int64]
    """[M] which of them."""
    poses: Floats
    """[M, 3]"""
    verdicts: NDArray[np.int8]
    """[M] 1 in the goal, -1 in the sink, else 0."""


def grid_policy_times(
    policy: GridPolicy | None, robot: Robot, problem: Problem, starts: Starts, rng: np.random.Generator
) -> Floats:
    """Time to the goal from each start, `[N]` s; inf where the sink or the limit comes first. Truth decides.

    Without a policy the linear controller drives.
    """
    times = np.full(len(starts), np.inf)
    for sample, driven in enumerate(drives(policy, robot, problem, starts, rng)):
        times[driven.robots[driven.verdicts == 1]] = sample * problem.sampling_s
    return times


def drives(
    policy: GridPolicy | None, robot: Robot, problem: Problem, starts: Starts, rng: np.random.Generator
) -> Iterator[Driven]:
    """Every sampling period of a robot from each start, until none drives or the limit has come."""
    poses = poses_of(points_of(starts.beta_rad, starts.alpha_rad, starts.d_m))
    drivetrain = Drivetrain(robot, len(poses))
    chooser = Chooser(policy, law_of(problem), np.array(problem.actions), len(poses), problem.sampling_s)
    driving = np.arange(len(starts))
    for _ in range(round(LIMIT_S / problem.sampling_s) + 1):
        verdicts = judge(problem.limits, states_of(poses))
        yield Driven(driving, poses, verdicts)
        going = verdicts == 0
        poses, driving = poses[going], driving[going]
        drivetrain.keep(going)
        chooser.keep(going)
        if not len(driving):
            break
        percepts = robot.percepts(poses, drivetrain.motions, rng)
        poses = drivetrain.drive(poses, chooser.act(percepts), problem.sampling_s)
