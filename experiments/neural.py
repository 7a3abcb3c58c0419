"""A neural learner: stable-baselines3's DQN on the Gymnasium environment, in robot time. Needs the extra `neural`.

It sees what the paper's learner sees, (beta, alpha), and has the same two actions, each held for half a second. Its
network decides every sampling period when it is evaluated. Only this module imports torch.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import torch
from stable_baselines3 import DQN

from docking.env import ID, Observation
from experiments.controller import docking_times
from experiments.evaluation import World
from experiments.problem import Floats, Problem
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import SAMPLING_S, protocol_starts

HOLD_PERIODS = 4
REWARD_SCALE = 0.01
"""The goal's 300 is too steep for a network."""
REVERSE_S = 10.0
"""Robot time of every way back, as in `Protocol`."""
SETTINGS: dict[str, Any] = {
    "learning_rate": 1e-3,
    "buffer_size": 50_000,
    "learning_starts": 200,
    "batch_size": 128,
    "gamma": 0.99,
    "train_freq": 1,
    "gradient_steps": 1,
    "target_update_interval": 250,
    "exploration_fraction": 0.25,
    "exploration_final_eps": 0.1,
    "policy_kwargs": {"net_arch": [64, 64]},
}
"""Ours. The package's own are for a million steps of a game; an hour of robot time has 3500 decisions."""


class Held(gymnasium.Wrapper[Observation, np.int64, Observation, np.int64]):
    """Holds each action for HOLD_PERIODS, scales the reward, and counts the robot's time.

    Attributes:
        driven_s: robot time spent driving.
        robot_s: with the ways back.
    """

    def __init__(self, env: gymnasium.Env[Observation, np.int64]) -> None:
        super().__init__(env)
        self.driven_s = self.robot_s = 0.0

    def step(self, action: np.int64) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One decision; ends early with the trial."""
        total = 0.0
        for _ in range(HOLD_PERIODS):
            seen, reward, terminated, truncated, info = self.env.step(action)
            total += float(reward)
            self.driven_s += SAMPLING_S
            self.robot_s += SAMPLING_S
            if terminated or truncated:
                self.robot_s += REVERSE_S
                break
        return seen, REWARD_SCALE * total, terminated, truncated, info


def rows(experiment: str, name: str, world: World, minutes: Sequence[float]) -> list[Row]:
    """Train on the geometric plant; rows at each of these robot times (increasing)."""
    torch.set_num_threads(1)
    env = Held(gymnasium.make(f"docking.env:{ID}", task=world.task, plant_noise=world.noise))
    model = DQN("MlpPolicy", env, seed=world.seed, device="cpu", **SETTINGS)
    found: list[Row] = []
    waiting, core_s, began = list(minutes), 0.0, time.process_time()

    def look(_locals: dict[str, Any], _globals: dict[str, Any]) -> bool:
        """After every decision: evaluate when it is time, and go on until the last."""
        nonlocal core_s, began
        while waiting and env.robot_s >= 60.0 * waiting[0]:
            core_s += time.process_time() - began
            label = Label(experiment, world.plant, name, world.seed, waiting.pop(0))
            found.extend(
                replace(row, robot_seconds_per_core_second=env.driven_s / core_s) for row in _scored(label, model)
            )
            began = time.process_time()
        return bool(waiting)

    most_decisions = int(60.0 * minutes[-1] / (HOLD_PERIODS * SAMPLING_S)) + 1
    model.learn(most_decisions, callback=look)
    return found


def _scored(label: Label, model: DQN) -> list[Row]:
    problem = Problem(plant=label.plant)
    moves = np.array(problem.actions)

    def act(beta: Floats, alpha: Floats, _d: Floats) -> tuple[Floats, Floats]:
        seen = torch.as_tensor(np.stack([beta, alpha], axis=1), dtype=torch.float32)
        with torch.no_grad():
            chosen = moves[model.q_net(seen).argmax(dim=1).numpy()]
        return chosen[:, 0], chosen[:, 1]

    return rows_of(label, docking_times(act, protocol_starts(), problem), 0.0)
