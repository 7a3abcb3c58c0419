"""A robot that trains in minutes: it drives up, fails, drives back by itself, and is never put anywhere."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.learner.perceptual import Perceptual, Planning, Seen
from components.pilot import reverse
from components.pilot.ports import Params
from components.pilot.progress import Start
from components.pilot.rules import Rules
from components.pilot.sight import Sight
from docking.grid_policy import UNKNOWN, GridPolicy
from docking.levels import Limits, judge
from docking.linear import BEST_TUNED, Linear
from docking.percept_filter import PerceptFilter
from experiments.problem import GRIPPER_M, Problem
from experiments.robot import HEIGHT_M, Drivetrain, Robot, poses_of
from experiments.starts import D_MIN_M

Floats = NDArray[np.float64]
_TRIAL_S, _REVERSE_S = 60.0, 40.0
"""Longest trial and longest way back."""


class Lesson(NamedTuple):
    """What was learned by a robot time."""

    minutes: float
    policy: GridPolicy
    structure: str
    trials: int


def perceptual_limits(problem: Problem, robot: Robot) -> Limits:
    """The problem's goal and sink as this robot perceives them: distances in its camera heights.

    Only the goal, which it is shown, is the robot's own; the limits of the task are those of the robot as it was built.
    """
    limits, goal_d = problem.limits, float(np.exp(robot.goal[2]))
    return limits._replace(
        d_min_m=D_MIN_M / HEIGHT_M,
        d_max_m=problem.d_max_m / HEIGHT_M,
        gripper_m=goal_d,
        docked_m=goal_d * limits.docked_m / GRIPPER_M,
    )


@dataclass
class Chooser:
    """Who drives: the plan where it knows an action, else the linear controller. One robot or many.

    The state is followed through the percept's noise and the command's delay with the rates that were learned.
    """

    policy: GridPolicy | None
    law: Linear
    actions: Floats
    """[actions, 2]"""
    count: int
    period_s: float
    exploring: bool = False
    """Actions that are only worth trying are tried."""

    def __post_init__(self) -> None:
        self.filter = None if self.policy is None else PerceptFilter(self.policy.model, self.count, self.period_s)

    def act(self, percepts: Floats) -> Floats:
        """Commands `[N, 2]` that answer percepts `[N, 3]` (beta, alpha, ln d)."""
        states = percepts
        chosen = np.full(len(percepts), UNKNOWN)
        if self.policy is not None and self.filter is not None:
            states = self.filter.ahead(self.filter.update(percepts))
            chosen = self.policy.act(states, exploring=self.exploring)
        commands = np.where((chosen == UNKNOWN)[:, None], self._taught(states), self.actions[chosen])
        if self.filter is not None:
            self.filter.send(commands)
        return commands

    def keep(self, kept: NDArray[np.bool_]) -> None:
        """Forget the other robots."""
        if self.filter is not None:
            self.filter.keep(kept)

    def _taught(self, states: Floats) -> Floats:
        """The fastest of the actions whose turn rate is nearest to the linear law's."""
        wanted = np.clip(
            self.law.k_beta_per_s * states[:, 0] + self.law.k_alpha_per_s * states[:, 1],
            -self.law.turn_rate_radps,
            self.law.turn_rate_radps,
        )
        off = np.abs(self.actions[:, 1] - wanted[:, None]) - 1e-3 * self.actions[:, 0]
        return np.asarray(self.actions[off.argmin(axis=1)])


def law_of(problem: Problem) -> Linear:
    """The teacher: best-tuned, at the commanded turn rate."""
    return Linear(*BEST_TUNED, max(omega for _, omega in problem.actions))


class Trainee:
    """One robot, its learner and its clock. Trials as the pilot runs them, driving back included.

    Args:
        robot: what it is not told.
        problem: what is to be learned.
        planning: how.
        seed: of its starts and its noise.
        number: of one of several robots.
        alike: learner of a robot that is built alike; None = it is alone.
    """

    def __init__(
        self,
        robot: Robot,
        problem: Problem,
        planning: Planning,
        seed: int,
        number: int = 0,
        alike: Perceptual | None = None,
    ) -> None:
        self.robot, self.problem = robot, problem
        self.rng = np.random.default_rng([seed, 6, number] if number else [seed, 6])
        self.limits = perceptual_limits(problem, robot)
        self.learner = Perceptual(planning, self.limits, problem.actions, alike)
        self.samples = self.trials = 0
        self._rules = Rules.of(Params(), seed)
        self._drivetrain = Drivetrain(robot, 1)
        self._pose = self._first_pose()
        self._actions = np.array(problem.actions)
        self._chooser = self._new_chooser()
        self._began = 0
        self._back: Start | None = None
        """Where the way back shall end; None while it drives up."""
        self._turning = False

    def lessons(self, minutes: Sequence[float]) -> Iterator[Lesson]:
        """Train, and stop at each of these robot times (increasing)."""
        for stop in minutes:
            while self.samples * self.problem.sampling_s < 60.0 * stop:
                self.sample()
            self.plan()
            fit, policy = self.learner.memory.fit, self.learner.policy()
            if fit is None or policy is None:
                raise RuntimeError(f"nothing was learned in {stop} minutes")
            yield Lesson(stop, policy, fit.structure.name, self.trials)

    def change(self, robot: Robot) -> None:
        """The robot becomes another one, and is shown its goal again."""
        self.robot, self._drivetrain = robot, Drivetrain(robot, 1)
        self.limits = perceptual_limits(self.problem, robot)
        self.learner.planner.aim(self.limits)

    def sample(self) -> bool:
        """One sampling period: see, learn, act, move. True if a new plan has begun."""
        percept = self.robot.percepts(self._pose, self._drivetrain.motions, self.rng)[0]
        state = (float(percept[0]), float(percept[1]), float(percept[2]))
        self._change_stage(state)
        command = self._command(percept)
        begun = self.learner.feed(Seen(state, command), 2 * self.trials + (self._back is not None))
        self._pose = self._drivetrain.drive(self._pose, np.array([command]), self.problem.sampling_s)
        self.samples += 1
        return begun

    def _change_stage(self, state: tuple[float, float, float]) -> None:
        late = (self.samples - self._began) * self.problem.sampling_s
        if self._back is None:
            verdict = judge(self.limits, np.array([[state[0], state[1], math.exp(state[2])]]))[0]
            if verdict != 0 or late > _TRIAL_S:
                self._back = reverse.drawn_start(self._rules, self.rng, _sight(state))
                self._began, self._turning = self.samples, False
            return
        self._turning = self._turning or reverse.is_far_enough(_sight(state), self._back)
        there = self._turning and reverse.has_turned(self._rules, _sight(state), self._back)
        if there or late > _REVERSE_S:
            self.plan()
            self._back, self._began, self._chooser = None, self.samples, self._new_chooser()
            self.trials += 1

    def _command(self, percept: Floats) -> tuple[float, float]:
        if self._back is None:
            v, omega = self._chooser.act(percept[None])[0].tolist()
            return v, omega
        move = reverse.turn if self._turning else reverse.back_off
        wish = move(self._rules, _sight(tuple(percept.tolist())), self._back)
        return wish.v_mps, wish.omega_radps

    def plan(self) -> None:
        """Learn from the newest way and plan to the end: what takes a second is over before the next trial."""
        self.learner.close()
        self.finish_plan()

    def take_plan(self) -> None:
        """Drive on by the plan that has begun, in the middle of a trial."""
        self.finish_plan()
        self._chooser = self._new_chooser()

    def finish_plan(self) -> None:
        """Plan to the end what has begun."""
        while self.learner.planner.busy:
            self.learner.advance(self.learner.planner.axes.d_nodes)

    def _new_chooser(self) -> Chooser:
        return Chooser(
            self.learner.policy(), law_of(self.problem), self._actions, 1, self.problem.sampling_s, exploring=True
        )

    def _first_pose(self) -> Floats:
        task = self.problem.task
        high = np.array((task.beta_range_rad, task.alpha_range_rad, 2.0))
        low = np.array((-task.beta_range_rad, -task.alpha_range_rad, 1.0))
        return poses_of(self.rng.uniform(low, high)[None])


def _sight(state: tuple[float, float, float]) -> Sight:
    return Sight(True, state[0], state[1], math.atan(math.exp(-state[2])))
