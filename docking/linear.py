"""The linear controller: omega = sat(k_beta beta + k_alpha alpha), on the state or, for a teacher, at the cell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from docking.cells import Grid


@dataclass(frozen=True, slots=True)
class Linear:
    """Gains of the paper's LC (section VI), saturated at the turn rate that the learner has too."""

    k_beta_per_s: float
    """Turn rate per radian of beta."""
    k_alpha_per_s: float
    """Turn rate per radian of alpha."""
    turn_rate_radps: float
    """Omega is cut off at +- this."""

    def omega_radps(self, beta_rad: float, alpha_rad: float) -> float:
        """Turn rate, positive to the left, for a state relative to the goal."""
        wanted = self.k_beta_per_s * beta_rad + self.k_alpha_per_s * alpha_rad
        return min(max(wanted, -self.turn_rate_radps), self.turn_rate_radps)


BEST_TUNED = (2.25, 1.5)
"""(k_beta, k_alpha) in 1/s that dock from the most starts on the geometric plant; found by a grid search."""
HAND_TUNED = (1.5, 1.5)
"""As above, without a search: what a person arrives at."""


def teacher_action(law: Linear, grid: Grid, cell: int, actions: Sequence[tuple[float, float]]) -> int:
    """Index of the action (v_mps, omega_radps) whose turn rate is nearest to the law's at the cell's *centre*.

    Asked at the state instead, the action would depend on where in the cell the robot is, and the learner's counts of
    (cell, action) would be confounded. A tie goes to the side on which the object is.
    """
    return lawful_action(law, *grid.centre(cell), actions)


def lawful_action(law: Linear, beta_rad: float, alpha_rad: float, actions: Sequence[tuple[float, float]]) -> int:
    """As above, at a state: of equal turn rates the fastest."""
    wanted = law.omega_radps(beta_rad, alpha_rad)
    side = 1.0 if (alpha_rad, beta_rad) >= (0.0, 0.0) else -1.0
    return min(range(len(actions)), key=lambda i: (abs(actions[i][1] - wanted), -side * actions[i][1], -actions[i][0]))


def teacher_table(law: Linear, grid: Grid, actions: Sequence[tuple[float, float]]) -> NDArray[np.int8]:
    """`teacher_action` of every cell, [cells]."""
    return np.array([teacher_action(law, grid, cell, actions) for cell in range(grid.count)], dtype=np.int8)
