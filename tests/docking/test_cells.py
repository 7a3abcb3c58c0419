"""Cells against their definition."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from docking.angles import DEG
from docking.cells import SINK, Grid
from docking.task import Task

GRID = Grid.of(Task())
cells = st.integers(0, GRID.count - 1)


def test_the_papers_grid_has_961_cells_with_the_goal_in_the_middle():
    assert GRID.count == 961
    assert GRID.centre(GRID.goal) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert GRID.cell(0.0, 0.0) == GRID.goal


@given(cells)
def test_a_cells_centre_lies_in_it(cell):
    assert GRID.cell(*GRID.centre(cell)) == cell


@given(cells, cells)
def test_distance_is_chebyshev(a, b):
    (row_a, column_a), (row_b, column_b) = divmod(a, 31), divmod(b, 31)
    assert GRID.distance(a, b) == max(abs(row_a - row_b), abs(column_a - column_b))


@given(cells)
def test_mirroring_negates_the_centre(cell):
    beta, alpha = GRID.centre(cell)
    assert GRID.centre(GRID.mirrored(cell)) == pytest.approx((-beta, -alpha), abs=1e-12)
    assert GRID.mirrored(GRID.mirrored(cell)) == cell


@pytest.mark.parametrize(
    "state", [(66 * DEG, 0.0), (-66 * DEG, 0.0), (0.0, 81 * DEG), (0.0, -81 * DEG), (math.nan, 0.0), (0.0, math.inf)]
)
def test_outside_the_ranges_and_nonsense_is_the_sink(state):
    assert GRID.cell(*state) == SINK
