"""Driving a learned grid policy from many starts, on the robot it was learned on."""

from __future__ import annotations

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


def grid_policy_times(
    policy: GridPolicy, robot: Robot, problem: Problem, starts: Starts, rng: np.random.Generator
) -> Floats:
    """Time to the goal from each start, `[N]` s; inf where the sink or the limit comes first. Truth decides."""
    poses = poses_of(points_of(starts.beta_rad, starts.alpha_rad, starts.d_m))
    drivetrain = Drivetrain(robot, len(poses))
    chooser = Chooser(policy, law_of(problem), np.array(problem.actions), len(poses), problem.sampling_s)
    times, driving = np.full(len(starts), np.inf), np.arange(len(starts))
    for sample in range(round(LIMIT_S / problem.sampling_s) + 1):
        verdicts = judge(problem.limits, states_of(poses))
        times[driving[verdicts == 1]] = sample * problem.sampling_s
        going = verdicts == 0
        poses, driving = poses[going], driving[going]
        drivetrain.keep(going)
        chooser.keep(going)
        if not len(driving):
            break
        poses = drivetrain.drive(poses, chooser.act(robot.percepts(poses, drivetrain.motions, rng)), problem.sampling_s)
    return times
