"""How good a controller is: share of the starts that reach the goal cell, and how fast. Any table, any linear law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from docking.cells import Grid
from docking.linear import Linear
from docking.policy import UNKNOWN, PolicyTable
from docking.task import Task
from experiments.rollout import dock
from experiments.starts import D_MIN_M, SAMPLING_S, Starts

PLANTS = ("geometric", "printed")


class Score(NamedTuple):
    """Over some starts."""

    controllable_percent: float
    docking_time_s: float | None
    """Mean over the starts that reach the goal; None if none does."""


@dataclass(frozen=True)
class World:
    """What the controllers are evaluated in."""

    task: Task
    plant: str = "geometric"
    noise: float = 0.0
    """Standard deviation of each sample's speed and turn rate, as a share of them."""
    seed: int = 0


def law_times(world: World, law: Linear, starts: Starts) -> NDArray[np.float64]:
    """Docking time of the continuous linear law from each start, [starts] s; inf where the goal is not reached."""
    unknown = np.full(Grid.of(world.task).count, UNKNOWN, dtype=np.int8)
    return _times(world, unknown, law, starts)


def policy_times(
    world: World, policy: PolicyTable, starts: Starts, where_unknown: Linear | None = None
) -> NDArray[np.float64]:
    """As `law_times`, for a table; in a cell it does not know, a law decides, or the last action goes on."""
    return _times(world, policy.action, where_unknown, starts)


def score(times_s: NDArray[np.float64]) -> Score:
    """Share of finite times and their mean."""
    reached = np.isfinite(times_s)
    mean = float(times_s[reached].mean()) if reached.any() else None
    return Score(100.0 * float(reached.mean()), mean)


def _times(world: World, table: NDArray[np.int8], law: Linear | None, starts: Starts) -> NDArray[np.float64]:
    task = world.task
    gains = (law.k_beta_per_s, law.k_alpha_per_s, law.turn_rate_radps) if law else (0.0, 0.0, 0.0)
    times: NDArray[np.float64] = dock(
        np.stack([starts.beta_rad, starts.alpha_rad, starts.d_m], axis=1),
        table,
        np.array(task.actions),
        *gains,
        law is None,
        world.plant == "printed",
        np.array([task.beta_range_rad, task.alpha_range_rad]),
        (task.beta_cells, task.alpha_cells),
        D_MIN_M,
        SAMPLING_S,
        world.noise,
        np.random.default_rng([world.seed, 7]),
    )
    return times
