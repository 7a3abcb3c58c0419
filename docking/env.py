"""The task as a Gymnasium environment, over the same plant as the simulator and the experiments.

    import gymnasium
    env = gymnasium.make("docking.env:berth/Docking-v0")

The part before the colon is the module that registers it. The version rises when the same seed and actions would give
other observations or rewards.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from docking import plant
from docking.cells import SINK, Grid
from docking.task import Task

ID = "berth/Docking-v0"
GOAL_REWARD, SINK_REWARD, STEP_REWARD = 300.0, -50.0, -1.0
"""Martinez-Marin and Duckett 2005, section VI: -n for a transition of n sampling periods."""
MAX_STEPS = 800
"""100 s; then the episode is truncated."""
_FARTHEST_M = 10.0

Observation = NDArray[np.float32]


class DockingEnv(gymnasium.Env[Observation, np.int64]):
    """Drive up to an object and face it along the table's normal.

    ## Observation
    `Box`, float32: beta in rad (angle between the table's normal and the line robot-object, -pi..pi), alpha in rad
    (bearing of the object from the heading, positive to the left, -pi..pi); with `distance=True` also d in m (distance
    of the object from the axle, 0..10). The paper's learner does not see d.

    ## Action
    `Discrete(2)`: turn left (0) or right (1) at 10 deg/s, for one sampling period of 0.125 s, at 0.1 m/s. With other
    `actions` the index into them.

    ## Reward
    -1 for every sampling period, +300 on entering the goal cell, -50 on entering the sink.

    ## Start
    Uniform over beta +-65 deg, alpha +-80 deg, d 1..2 m, outside the goal cell; or `options={"start": (beta_rad,
    alpha_rad, d_m)}` of `reset`.

    ## End
    `terminated` in the goal cell, at any distance, or in the sink: outside the ranges of beta and alpha, or nearer than
    0.2 m. `truncated` after 800 steps (by the registration). `info["outcome"]` is `goal`, `sink` or empty;
    `info["pose"]` is (x m, y m, heading rad) of the axle.

    Args:
        task: ranges, cells, speed and turn rate.
        actions: (v m/s, omega rad/s) of each; None = the task's.
        distance: d is observed.
        plant_noise: standard deviation of each step's speed and turn rate, as a share of them.
        sampling_s: length of a step.
        d_min_m: nearer is the sink.
    """

    def __init__(
        self,
        task: Task | None = None,
        *,
        actions: tuple[tuple[float, float], ...] | None = None,
        distance: bool = False,
        plant_noise: float = 0.0,
        sampling_s: float = 0.125,
        d_min_m: float = 0.2,
    ) -> None:
        self.task = task or Task()
        self.actions = self.task.actions if actions is None else actions
        self.render_mode = None
        self._grid = Grid.of(self.task)
        self._distance, self._noise, self._dt_s, self._d_min_m = distance, plant_noise, sampling_s, d_min_m
        self._pose = (0.0, 0.0, 0.0)
        high = np.array((np.pi, np.pi, _FARTHEST_M)[: 3 if distance else 2], dtype=np.float32)
        low = np.array((-np.pi, -np.pi, 0.0)[: high.size], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(low, high, dtype=np.float32)
        self.action_space = gymnasium.spaces.Discrete(len(self.actions))

    def reset(
        self, *, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Put the robot at a start; returns observation and info.

        Raises:
            ValueError: the start of `options` is not three finite numbers with d > 0.
        """
        super().reset(seed=seed)
        start = self._drawn() if options is None or "start" not in options else tuple(map(float, options["start"]))
        if len(start) != 3 or not np.isfinite(start).all() or start[2] <= 0.0:
            raise ValueError(f'options["start"] must be (beta_rad, alpha_rad, d_m) with d_m > 0; got {start}')
        self._pose = plant.pose(*start)
        return self._observation(), self._info("")

    def step(self, action: np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Drive for one sampling period; returns observation, reward, terminated, truncated, info."""
        v, omega = self.actions[int(action)]
        if self._noise > 0.0:
            v, omega = np.array((v, omega)) * self.np_random.normal(1.0, self._noise, 2)
        self._pose = plant.advance(*self._pose, float(v), float(omega), self._dt_s)
        outcome = self._outcome()
        reward = STEP_REWARD + {"goal": GOAL_REWARD, "sink": SINK_REWARD, "": 0.0}[outcome]
        return self._observation(), reward, bool(outcome), False, self._info(outcome)

    def _drawn(self) -> tuple[float, float, float]:
        ranges = (self.task.beta_range_rad, self.task.alpha_range_rad)
        while True:
            beta, alpha, d = self.np_random.uniform((-ranges[0], -ranges[1], 1.0), (*ranges, 2.0))
            if self._grid.cell(beta, alpha) != self._grid.goal:
                return float(beta), float(alpha), float(d)

    def _outcome(self) -> str:
        beta, alpha, d = plant.observe(*self._pose)
        cell = self._grid.cell(beta, alpha)
        if cell == SINK or d < self._d_min_m:
            return "sink"
        return "goal" if cell == self._grid.goal else ""

    def _observation(self) -> Observation:
        state = plant.observe(*self._pose)
        observed = np.array(state if self._distance else state[:2], dtype=np.float32)
        return np.clip(observed, self.observation_space.low, self.observation_space.high)  # type: ignore[attr-defined]

    def _info(self, outcome: str) -> dict[str, Any]:
        return {"outcome": outcome, "pose": self._pose}


if ID not in gymnasium.registry:
    gymnasium.register(id=ID, entry_point="docking.env:DockingEnv", max_episode_steps=MAX_STEPS)
