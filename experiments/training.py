"""The kinematic training loop, off the bus: trials of a method, robot time counted, policies at checkpoints.

Protocol: training starts uniform over the ranges and 1 to 2 m; the trial ends at the goal cell, outside the ranges, or
below 0.2 m; driving back costs a fee of robot time.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.learner.methods import make_method
from components.learner.methods.tabular import Tabular
from components.learner.settings import Settings
from components.learner.transition import Transition
from docking.cells import Grid
from docking.linear import HAND_TUNED, Linear, teacher_table
from docking.policy import UNKNOWN, PolicyTable
from docking.task import Task
from experiments.evaluation import PLANTS
from experiments.rollout import drive_trial
from experiments.starts import D_MIN_M, SAMPLING_S
from runtime.params import ConfigurationError

CONTROLLERS = ("random", "lc", "greedy", "optimist")
"""Who may drive a training trial: random actions; the teacher asked at the cell; the policy learned so far; the largest
Q where what was never tried counts as `Settings.unknown_value`."""


@dataclass(frozen=True)
class Protocol:
    """How the robot trains."""

    plant: str = "geometric"
    """`geometric` or `printed`."""
    cycle: tuple[str, ...] = ("random",)
    """Controllers, trial by trial, over and over. RL: random. RL-LC: lc, random."""
    teacher: tuple[float, float] = HAND_TUNED
    """k_beta and k_alpha of the linear law, 1/s."""
    teacher_where_unknown: bool = False
    """A greedy trial asks the teacher in cells without a known action; otherwise it explores there."""
    explore: float = 0.0
    """Share of random actions in the trials of `lc`, `greedy` and `optimist`."""
    explore_minutes: float = 0.0
    """That share falls linearly to nothing until then; 0: it stays."""
    reverse_s: float = 10.0
    """Robot time that driving back costs."""
    plant_noise: float = 0.0
    """Standard deviation of each sample's speed and turn rate, as a share of them."""
    percept_noise_rad: float = 0.0
    """Standard deviation of beta and alpha as the learner sees them."""
    start_distances_m: tuple[float, float] = (1.0, 2.0)
    """Training starts are uniform between these."""
    easy_minutes: float = 0.0
    """Learning from Easy Missions (Asada 1996): starts begin near the goal and reach the whole ranges so late."""
    cycle_after: tuple[str, ...] = ()
    """Two-phase teaching (Smart and Kaelbling 2002): the cycle from `switch_minutes` on."""
    switch_minutes: float = 0.0

    def __post_init__(self) -> None:
        for name in (*self.cycle, *self.cycle_after):
            if name not in CONTROLLERS:
                raise ConfigurationError(f"protocol.cycle must be of {', '.join(CONTROLLERS)}; got {name!r}")
        if self.plant not in PLANTS:
            raise ConfigurationError(f"protocol.plant must be one of {', '.join(PLANTS)}; got {self.plant!r}")


class Checkpoint(NamedTuple):
    """The state of a training at a robot time."""

    minutes: float
    policy: PolicyTable
    trials: int
    reached: int
    driven_s: float
    core_s: float
    """Processor time spent on simulating and learning so far."""


@dataclass
class Training:
    """A robot, a method and a clock of robot time."""

    task: Task = field(default_factory=Task)
    settings: Settings = field(default_factory=Settings)
    protocol: Protocol = field(default_factory=Protocol)
    seed: int = 0

    def __post_init__(self) -> None:
        self.method: Tabular = make_method(self.task, self.settings)
        self.rng = np.random.default_rng([self.seed, 2005])
        self.robot_s = self.driven_s = self.core_s = 0.0
        self.trials = self.reached = 0
        self._grid = Grid.of(self.task)
        self._actions = np.array(self.task.actions)
        self._teacher = teacher_table(
            Linear(*self.protocol.teacher, self.task.turn_rate_radps), self._grid, self.task.actions
        )

    def checkpoints(self, minutes: Sequence[float]) -> Iterator[Checkpoint]:
        """Train, and stop at each of these robot times (increasing)."""
        for stop in minutes:
            while self.robot_s < 60.0 * stop:
                began = time.process_time()
                self.trial()
                self.core_s += time.process_time() - began
            policy = self.method.table()
            yield Checkpoint(stop, policy, self.trials, self.reached, self.driven_s, self.core_s)

    def trial(self) -> None:
        """One trial, learned from transition by transition, and the way back."""
        rows, samples, reached = self._drive(self._controller())
        for row in rows.tolist():
            self._learn(row)
        self.driven_s += samples * SAMPLING_S
        self.robot_s += samples * SAMPLING_S + self.protocol.reverse_s
        self.trials += 1
        self.reached += reached

    def _learn(self, row: list[float]) -> None:
        cell, action, entered, periods, beta_change, alpha_change, near = row
        seen = Transition(
            cell=int(cell),
            action=int(action),
            next_cell=int(entered),
            periods=periods,
            beta_change_rad=beta_change,
            alpha_change_rad=alpha_change,
            motion_periods=periods,
            too_close=near > 0.0,
        )
        if self.method.observe(seen):
            self.method.plan()

    def _drive(self, controller: str) -> tuple[NDArray[np.float64], int, bool]:
        protocol, task = self.protocol, self.task
        rows, samples, reached = drive_trial(
            self._start(),
            self._table(controller),
            self._actions,
            0.0 if controller == "random" else self._explore(),
            self.settings.adjoining_cells,
            self.settings.hold_periods,
            protocol.plant == "printed",
            np.array([task.beta_range_rad, task.alpha_range_rad]),
            (task.beta_cells, task.alpha_cells),
            D_MIN_M,
            SAMPLING_S,
            protocol.plant_noise,
            protocol.percept_noise_rad,
            self.rng,
        )
        return rows, int(samples), bool(reached)

    def _explore(self) -> float:
        share, until_s = self.protocol.explore, 60.0 * self.protocol.explore_minutes
        return share * max(0.0, 1.0 - self.robot_s / until_s) if until_s > 0.0 else share

    def _controller(self) -> str:
        protocol = self.protocol
        late = protocol.cycle_after and self.robot_s >= 60.0 * protocol.switch_minutes
        cycle = protocol.cycle_after if late else protocol.cycle
        return cycle[self.trials % len(cycle)]

    def _table(self, controller: str) -> NDArray[np.int8]:
        if controller == "lc":
            return self._teacher
        if controller == "greedy":
            policy = self.method.table().action
            return np.where(policy == UNKNOWN, self._teacher, policy) if self.protocol.teacher_where_unknown else policy
        if controller == "optimist":
            return self.method.explorer()
        return np.full(self._grid.count, UNKNOWN, dtype=np.int8)

    def _start(self) -> NDArray[np.float64]:
        scale = 1.0
        if self.protocol.easy_minutes > 0.0:
            scale = min(1.0, 0.1 + 0.9 * self.robot_s / (60.0 * self.protocol.easy_minutes))
        beta, alpha = scale * self.task.beta_range_rad, scale * self.task.alpha_range_rad
        near, far = self.protocol.start_distances_m
        return self.rng.uniform((-beta, -alpha, near), (beta, alpha, far))
