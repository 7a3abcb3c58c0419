"""Uniform cells over (beta, alpha), the goal in the middle one. Alpha runs fastest in a cell's index."""

from __future__ import annotations

import math
from dataclasses import dataclass

from docking.task import Task

SINK = -1
"""Index of the one cell outside the ranges."""


def cell_of(
    beta_rad: float,
    alpha_rad: float,
    beta_range_rad: float,
    alpha_range_rad: float,
    beta_cells: int,
    alpha_cells: int,
) -> int:
    """Index of the cell that holds (beta, alpha), or SINK outside the ranges. Plain Python that numba can compile."""
    if not (abs(beta_rad) <= beta_range_rad and abs(alpha_rad) <= alpha_range_rad):  # true for NaN too
        return -1
    row = math.floor((beta_rad + beta_range_rad) * beta_cells / (2.0 * beta_range_rad))
    column = math.floor((alpha_rad + alpha_range_rad) * alpha_cells / (2.0 * alpha_range_rad))
    if row < 0 or row >= beta_cells or column < 0 or column >= alpha_cells:
        return -1
    return row * alpha_cells + column


@dataclass(frozen=True, slots=True)
class Grid:
    """Cells over +-beta_range_rad by +-alpha_range_rad."""

    beta_range_rad: float
    alpha_range_rad: float
    beta_cells: int
    alpha_cells: int

    @staticmethod
    def of(task: Task) -> Grid:
        """The cells of a task."""
        return Grid(task.beta_range_rad, task.alpha_range_rad, task.beta_cells, task.alpha_cells)

    @property
    def count(self) -> int:
        """Number of cells, without the sink."""
        return self.beta_cells * self.alpha_cells

    @property
    def goal(self) -> int:
        """The cell of (0, 0)."""
        return (self.beta_cells // 2) * self.alpha_cells + self.alpha_cells // 2

    def cell(self, beta_rad: float, alpha_rad: float) -> int:
        """Index of the cell, or SINK."""
        return cell_of(
            beta_rad,
            alpha_rad,
            self.beta_range_rad,
            self.alpha_range_rad,
            self.beta_cells,
            self.alpha_cells,
        )

    def centre(self, cell: int) -> tuple[float, float]:
        """(beta_rad, alpha_rad) in the middle of a cell."""
        row, column = divmod(cell, self.alpha_cells)
        return (
            (2 * row + 1 - self.beta_cells) * self.beta_range_rad / self.beta_cells,
            (2 * column + 1 - self.alpha_cells) * self.alpha_range_rad / self.alpha_cells,
        )

    def mirrored(self, cell: int) -> int:
        """Cell of (-beta, -alpha)."""
        return SINK if cell == SINK else self.count - 1 - cell

    def distance(self, a: int, b: int) -> int:
        """Chebyshev distance between two cells, max_i |a_i - b_i| (paper, eq. 5)."""
        row_a, column_a = divmod(a, self.alpha_cells)
        row_b, column_b = divmod(b, self.alpha_cells)
        return max(abs(row_a - row_b), abs(column_a - column_b))
