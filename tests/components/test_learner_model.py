from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.learner.model import DisplacementModel, ExitModel, ring_shares, square_shares
from components.learner.settings import Settings
from components.learner.transition import Transition
from docking.cells import SINK, Grid

GRID = Grid(1.0, 1.0, 21, 21)
WIDTH = 2.0 / 21
SETTINGS = Settings()
BOTH = pytest.mark.parametrize("kind", [ExitModel, DisplacementModel])


def drifting(count, rows, columns, noise=0.0, seed=0, cell=100):
    """Transitions of a point that crosses cells at a constant rate per period, action held until the cell changes;
    shifted to one cell, as if every cell were alike."""
    rng = np.random.default_rng(seed)
    at, inside, transitions = rng.uniform(0, 1, 2), np.zeros(2), []
    while len(transitions) < count:
        start, n = at.copy(), 0
        while (np.floor(at + inside) == 0).all():
            at = at + np.array([rows, columns])
            inside = noise * rng.standard_normal(2)
            n += 1
        row, column = np.floor(at + inside).astype(int)
        change = (at + inside - start) * WIDTH
        if max(abs(row), abs(column)) == 1:
            transitions.append(Transition(cell, 0, cell + 21 * row + column, n, change[0], change[1], n))
        at, inside = at % 1.0, np.zeros(2)
    return transitions


def learned(kind, transitions, settings=SETTINGS):
    model = kind(GRID, 2, settings)
    for transition in transitions:
        assert model.observe(transition)
    return model


def drift_of(model, pair, cell=100):
    """Expected change of the cell, (rows, columns), under the model."""
    used = slice(0, model.degree[pair])
    successors, weights = model.successor[pair, used], model.weight[pair, used]
    return sum(w * np.array(divmod(s, 21)) for s, w in zip(successors, weights, strict=True)) - np.array(
        divmod(cell, 21)
    )


@BOTH
@pytest.mark.parametrize("slow", [0.02, -0.03, 0.06])
def test_slow_drift_is_kept_while_the_other_variable_crosses_a_cell(kind, slow):
    """Bearing crosses a cell in four periods while beta moves a fraction of one."""
    model = learned(kind, drifting(600, slow, 0.25))
    rows, columns = drift_of(model, 200)
    assert columns > 0.5
    assert rows / columns == pytest.approx(slow / 0.25, rel=0.1)


@BOTH
@pytest.mark.parametrize(("rows", "columns"), [(0.02, 0.25), (0.2, -0.21), (0.0, 0.1), (-0.3, 0.0)])
def test_no_weight_falls_back_on_the_cell_itself(kind, rows, columns):
    model = learned(kind, drifting(300, rows, columns, noise=0.1))
    used = slice(0, model.degree[200])
    assert model.weight[200, used][model.successor[200, used] == 100].sum() == 0.0
    assert model.weight[200, used].sum() == pytest.approx(1.0)


def test_exits_through_opposite_faces_average_to_their_relative_counts():
    exits = [101, 101, 99, 121, 101, SINK]
    model = learned(ExitModel, [Transition(100, 1, s, 4.0, 0.0, 0.0, 4.0) for s in exits])
    shares = dict(zip(model.successor[201], model.weight[201], strict=True))
    assert (shares[101], shares[99], shares[121], shares[441]) == pytest.approx((3 / 6, 1 / 6, 1 / 6, 1 / 6))
    assert model.reward[201] == pytest.approx((5 * -4.0 - 50.0) / 6)


def test_mean_motion_through_opposite_faces_never_ends_in_the_cell():
    changes = [(0.0, WIDTH), (0.0, -0.9 * WIDTH), (0.3 * WIDTH, 0.0)]
    model = learned(DisplacementModel, [Transition(100, 0, 101, 4.0, b, a, 4.0) for b, a in changes])
    assert (model.successor[200, 1:3] != 100).all()
    assert (model.weight[200, :3] >= 0.0).all()


def test_the_reward_of_mean_motion_is_the_time_to_the_ring_of_adjoining_cells():
    seen = Transition(100, 0, 101, 4.0, 0.0, 0.5 * WIDTH, 3.0)
    model = learned(DisplacementModel, [seen])
    assert model.reward[200] == pytest.approx(-6.0)


def test_entering_goal_and_sink_is_rewarded_as_in_the_paper():
    goal = GRID.goal
    for kind in (ExitModel, DisplacementModel):
        into_goal = learned(kind, [Transition(goal - 1, 0, goal, 5.0, 0.0, WIDTH, 5.0)])
        assert into_goal.reward[2 * (goal - 1)] == 300.0
        out = learned(kind, [Transition(5, 0, SINK, 5.0, -WIDTH, 0.0, 5.0)])
        assert out.reward[10] == -50.0
        close = learned(kind, [Transition(100, 0, SINK, 5.0, 0.0, 0.1 * WIDTH, 5.0, too_close=True)])
        assert close.reward[200] == -50.0


@BOTH
def test_the_mirror_image_of_a_model_is_the_model_of_the_mirrored_transitions(kind):
    rng = np.random.default_rng(4)
    straight, mirrored = kind(GRID, 2, SETTINGS), kind(GRID, 2, SETTINGS)
    for _ in range(60):
        row, column = [(0, 1), (1, 1), (-1, 0), (1, -1)][rng.integers(4)]
        b, a = (np.array([row, column]) + rng.normal(0, 0.1, 2)) * WIDTH
        straight.observe(Transition(40, 1, 40 + 21 * row + column, 3.0, b, a, 3.0))
        image = GRID.mirrored(40)
        mirrored.observe(Transition(image, 0, image - 21 * row - column, 3.0, -b, -a, 3.0))
    straight.mirror(81, 2 * GRID.mirrored(40))
    image = 2 * GRID.mirrored(40)
    used = slice(0, straight.degree[image])
    for name, array in straight.arrays().items():
        row, other = np.atleast_1d(array[image]), np.atleast_1d(mirrored.arrays()[name][image])
        np.testing.assert_allclose(row[used], other[used])


def test_a_model_without_room_for_another_successor_refuses_it():
    model = ExitModel(GRID, 2, SETTINGS)
    assert all(model.observe(Transition(100, 0, 200 + s, 1.0, 0.0, 0.0, 1.0)) for s in range(9))
    assert not model.observe(Transition(100, 0, 300, 1.0, 0.0, 0.0, 1.0))
    assert model.visits[200] == 9


@given(st.floats(-3, 3), st.floats(-3, 3), st.integers(1, 3))
def test_ring_cells_are_at_the_distance_and_their_mean_is_the_point_pushed_out_to_it(rows, columns, reach):
    largest = max(abs(rows), abs(columns))
    if largest < 0.01:
        return
    rows, columns = rows * reach / largest, columns * reach / largest
    shares = ring_shares(rows, columns, reach)
    assert sum(share for _, _, share in shares) == pytest.approx(1.0)
    assert all(max(abs(r), abs(c)) == reach and share >= 0.0 for r, c, share in shares)
    assert sum(r * share for r, _, share in shares) == pytest.approx(rows)
    assert sum(c * share for _, c, share in shares) == pytest.approx(columns)


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_bilinear_shares_have_their_mean_at_the_point(rows, columns):
    shares = square_shares(rows, columns)
    assert math.isclose(sum(share for _, _, share in shares), 1.0)
    assert sum(r * share for r, _, share in shares) == pytest.approx(rows)
    assert sum(c * share for _, c, share in shares) == pytest.approx(columns)
