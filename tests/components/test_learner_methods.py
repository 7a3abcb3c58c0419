from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from components.learner.methods import METHODS, make_method
from components.learner.methods.tabular import greedy
from components.learner.settings import Settings
from components.learner.transition import Transition
from docking.cells import SINK, Grid
from docking.policy import UNKNOWN
from docking.task import Task

TASK = Task(beta_cells=7, alpha_cells=7)
GRID = Grid.of(TASK)
GOAL = GRID.goal
WIDTH = 2 * TASK.alpha_range_rad / 7
HEIGHT = 2 * TASK.beta_range_rad / 7


def random_transitions(count, seed=0):
    """Between neighbours, some into the sink; every cell and action."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        cell = int(rng.integers(GRID.count))
        row, column = 0, 0
        while row == column == 0:
            row, column = rng.integers(-1, 2, 2)
        inside = 0 <= cell // 7 + row < 7 and 0 <= cell % 7 + column < 7
        n = int(rng.integers(1, 9))
        after = cell + 7 * row + column if inside else SINK
        beta_change, alpha_change = (np.array([row, column]) + rng.normal(0.0, 0.1, 2)) * (HEIGHT, WIDTH)
        yield Transition(cell, int(rng.integers(2)), int(after), n, beta_change, alpha_change, n)


def taught(settings, transitions):
    method = make_method(TASK, settings)
    for transition in transitions:
        if method.observe(transition):
            method.plan()
    return method


def solved(model):
    """Q by textbook value iteration over the model's arrays: the definition, slowly."""
    q = np.zeros(2 * GRID.count)
    for _ in range(500):
        v = np.append(q.reshape(-1, 2).max(axis=1), 0.0)
        for pair in np.flatnonzero(model.degree):
            used = slice(0, model.degree[pair])
            q[pair] = model.reward[pair] + model.weight[pair, used] @ v[model.successor[pair, used]]
    return q


@pytest.mark.parametrize("mirror", [True, False])
@pytest.mark.parametrize("model", ["exits", "displacement"])
def test_sweeps_converge_to_the_value_iteration_of_the_model(model, mirror):
    method = taught(Settings(model=model, mirror=mirror), random_transitions(400))
    for _ in range(300):
        method.plan()
    np.testing.assert_allclose(method.q, solved(method.model), atol=1e-6)


def test_prioritised_sweeping_converges_to_the_same_values_without_looking_at_everything():
    method = taught(Settings(method="prioritised", backups=5), random_transitions(400))
    full = taught(Settings(), random_transitions(400))
    for _ in range(3000):
        method.plan()
    for _ in range(300):
        full.plan()
    np.testing.assert_allclose(method.q, full.q, atol=1e-3)


def test_a_sweep_with_the_inverse_learning_rate_moves_by_one_over_the_visits():
    method = make_method(TASK, Settings(learning_rate="inverse", sweeps=1))
    for _ in range(4):
        method.observe(Transition(0, 0, 1, 3.0, 0.0, WIDTH, 3.0))
    method.plan()
    assert method.q[0] == pytest.approx(-3.0 / 4)


def test_one_sweep_carries_news_along_the_order_of_the_cells_and_n_sweeps_further():
    """A corridor towards the goal against the order of the cells: one sweep, one cell."""
    chain = [Transition(GOAL - k - 1, 0, GOAL - k, 1.0, 0.0, WIDTH, 1.0) for k in range(3)]
    for sweeps, expected in ((1, [300.0, 0.0, 0.0]), (3, [300.0, 299.0, 298.0])):
        method = make_method(TASK, Settings(sweeps=sweeps, mirror=False))
        for transition in chain:
            method.observe(transition)
        method.plan()
        reached = [method.q[2 * (GOAL - k - 1)] for k in range(3)]
        assert [value > 200.0 for value in reached] == [value > 200.0 for value in expected]
        if sweeps == 3:
            assert reached == pytest.approx(expected)


def test_q_learning_averages_its_targets():
    method = taught(
        Settings(method="q-learning", mirror=False),
        [Transition(0, 0, 1, n, 0.0, WIDTH, n) for n in (2.0, 4.0, 9.0)],
    )
    assert method.q[0] == pytest.approx(-5.0)
    assert method.q[1] == 0.0


def test_advantage_learning_of_scale_one_is_q_learning_and_a_smaller_scale_stretches_differences():
    transitions = list(random_transitions(600))
    plain = taught(Settings(method="q-learning"), transitions)
    one = taught(Settings(method="advantage", advantage_scale=1.0), transitions)
    small = taught(Settings(method="advantage", advantage_scale=0.3), transitions)
    np.testing.assert_allclose(one.q, plain.q)
    assert np.abs(np.diff(small.q.reshape(-1, 2))).mean() > 1.5 * np.abs(np.diff(plain.q.reshape(-1, 2))).mean()


@pytest.mark.parametrize("scale", [0.1, 0.3, 1.0])
def test_no_advantage_leaves_the_range_of_the_returns(scale):
    """With a learning rate of 1 / visits the stretch overshoots at first visits, and more from cell to cell."""
    chain = [Transition(GOAL - k - 1, 0, GOAL - k, 1.0, 0.0, WIDTH, 1.0) for k in range(3)]
    method = make_method(TASK, Settings(method="advantage", advantage_scale=scale, mirror=False))
    for transition in chain * 3:
        method.observe(transition)
        assert -10.0 < method.q.min() <= method.q.max() <= 300.0


@pytest.mark.parametrize("name", METHODS)
def test_mirrored_transition_updates_the_mirrored_cell_and_the_policy_is_symmetric(name):
    method = taught(Settings(method=name), random_transitions(150))
    values = method.q.reshape(-1, 2)
    np.testing.assert_allclose(values, values[::-1, ::-1], atol=1e-12)
    assert method.table().mirror_faults == 0


@pytest.mark.parametrize("name", METHODS)
def test_learning_from_mirrored_experience_gives_the_mirrored_values(name):
    transitions = list(random_transitions(150))
    image = [
        Transition(GRID.mirrored(t.cell), 1 - t.action, GRID.mirrored(t.next_cell), t.periods, -t[4], -t[5], t[6])
        for t in transitions
    ]
    straight = taught(Settings(method=name), transitions)
    mirrored = taught(Settings(method=name), image)
    np.testing.assert_allclose(straight.q, mirrored.q, atol=1e-9)


@pytest.mark.parametrize("name", METHODS)
def test_without_the_mirror_the_other_half_stays_unknown(name):
    method = taught(
        Settings(method=name, mirror=False),
        [t for t in random_transitions(300) if t.cell < GOAL and t.next_cell < GOAL],
    )
    assert (method.table().action[GOAL:] == UNKNOWN).all()
    assert method.table().known > 10


@pytest.mark.parametrize(
    ("reach", "cell", "after", "counts"),
    [
        (1, 0, 1, True),
        (1, 0, 8, True),
        (1, 0, 2, False),
        (1, 0, 0, False),
        (1, 0, SINK, True),
        (2, 0, 2, True),
        (2, 0, 1, False),
        (1, GOAL, GOAL + 1, False),
        (1, SINK, 0, False),
    ],
)
def test_a_transition_counts_if_the_cell_changes_by_exactly_k(reach, cell, after, counts):
    method = make_method(TASK, Settings(adjoining_cells=reach))
    assert method.observe(Transition(cell, 0, after, 2.0, 0.01, 0.02, 2.0)) == counts
    assert (method.transitions, method.dropped) == (int(counts), int(not counts))


@pytest.mark.parametrize(("rule", "counts"), [("ignored", False), ("sink", True)])
def test_coming_too_close_counts_only_where_it_is_called_a_sink(rule, counts):
    method = make_method(TASK, Settings(too_close=rule))
    assert method.observe(Transition(0, 0, SINK, 2.0, 0.01, 0.02, 2.0, too_close=True)) == counts
    assert method.observe(Transition(0, 0, SINK, 2.0, 0.01, 0.02, 2.0))


def test_with_a_fixed_hold_every_successor_counts_the_cell_itself_too():
    method = make_method(TASK, Settings(hold_periods=4, model="exits"))
    assert all(method.observe(Transition(0, 0, s, 4.0, 0.0, 0.0, 4.0)) for s in (0, 0, 0, 2, 10))
    assert method.model.weight[0, 0] == pytest.approx(3 / 5)


def test_greedy_knows_only_what_was_tried_and_breaks_ties_symmetrically():
    q, known = np.zeros(18), np.ones(18, dtype=bool)
    known[[0, 1, 2, 14, 15]] = False
    action, value = greedy(q, known, np.array([1, 0], dtype=np.int32), mirror=False)
    assert list(action) == [UNKNOWN, 1, 0, 0, 0, 0, 0, UNKNOWN, 0]
    assert (value == 0.0).all()
    symmetric, _ = greedy(q, np.ones(18, dtype=bool), np.array([1, 0], dtype=np.int32), mirror=True)
    assert list(symmetric) == [0, 0, 0, 0, 0, 1, 1, 1, 1]


def test_a_state_of_another_grid_is_refused():
    other = make_method(Task(beta_cells=9, alpha_cells=7), Settings()).save()
    with pytest.raises(ValueError, match="cells"):
        make_method(TASK, Settings()).load(other)


@pytest.mark.parametrize(
    ("name", "place", "value"), [("successor", (3, 0), 10_000), ("q", 4, np.nan), ("degree", 7, 99)]
)
def test_a_state_with_impossible_numbers_is_refused(name, place, value):
    method = taught(Settings(), random_transitions(50))
    arrays = method._arrays()
    arrays[name][place] = value
    fresh = make_method(TASK, Settings())
    with pytest.raises(ValueError, match=r"cells|finite"):
        fresh.load(method.save())
    assert not fresh.q.any()


def test_settings_name_only_methods_that_exist():
    rule = next(field for field in dataclasses.fields(Settings) if field.name == "method").metadata["rule"]
    assert all(rule.holds(name) for name in METHODS)
    assert not rule.holds("magic")
