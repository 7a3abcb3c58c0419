"""Start states that controllers are compared on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from docking.cells import Grid
from docking.starts import start
from docking.task import Task

Floats = NDArray[np.float64]

DISTANCES_M = (1.0, 1.25, 1.5, 1.75, 2.0)
"""Start distances of the protocol: "a rectangle between 1 and 2 m" (Martinez-Marin and Duckett 2005, section VI)."""
D_MIN_M = 0.2
"""Closer than this is the sink."""
SAMPLING_S = 0.125
"""Sampling period Ts, Table I."""


@dataclass(frozen=True)
class Starts:
    """Start states, `[N]` each."""

    beta_rad: Floats
    alpha_rad: Floats
    d_m: Floats

    def __len__(self) -> int:
        """N."""
        return len(self.d_m)


def protocol_starts(task: Task | None = None, distances_m: tuple[float, ...] = DISTANCES_M) -> Starts:
    """All cell centres at each distance, distance by distance: `[len(distances_m) * cells]`."""
    grid = Grid.of(task or Task())
    centres = np.array([grid.centre(cell) for cell in range(grid.count)])
    return Starts(
        np.tile(centres[:, 0], len(distances_m)),
        np.tile(centres[:, 1], len(distances_m)),
        np.repeat(np.array(distances_m), grid.count),
    )


def demo_starts(count: int = 500, seed: int = 2005) -> Starts:
    """The simulator's own list of demonstration starts (`docking.starts`), so that everybody compares on the same."""
    rows = np.array([start("demo", seed, number, Task()) for number in range(count)])
    return Starts(*rows.T.copy())
