from __future__ import annotations

import math

import numpy as np
import pytest

from docking import plant
from docking.cells import SINK, Grid
from docking.linear import BEST_TUNED, Linear, teacher_table
from docking.task import Task
from experiments.rollout import dock, drive_trial, step
from experiments.starts import D_MIN_M, SAMPLING_S

TASK = Task()
GRID = Grid.of(TASK)
ACTIONS = np.array(TASK.actions)
RANGES = np.array([TASK.beta_range_rad, TASK.alpha_range_rad])
SHAPE = (TASK.beta_cells, TASK.alpha_cells)
PLANTS = pytest.mark.parametrize("printed", [False, True])
STATES = np.random.default_rng(3).uniform((-1.1, -1.3, 0.3), (1.1, 1.3, 2.0), (40, 3))


def trial(start, table, *, explore=0.0, reach=1, hold=0, printed=False, noise=0.0, percept_noise=0.0, seed=0):
    rng = np.random.default_rng(seed)
    plan = (reach, hold, printed, RANGES, SHAPE, D_MIN_M, SAMPLING_S, noise, percept_noise, rng)
    return drive_trial(np.array(start), table, ACTIONS, explore, *plan)


def times(starts, table, gains=(0.0, 0.0, 0.0), *, keep=True, printed=False, noise=0.0, seed=0):
    rng = np.random.default_rng(seed)
    return dock(starts, table, ACTIONS, *gains, keep, printed, RANGES, SHAPE, D_MIN_M, SAMPLING_S, noise, rng)


@PLANTS
@pytest.mark.parametrize("omega", [-0.17, 0.0, 0.17])
def test_mirroring_a_state_and_its_action_mirrors_the_outcome(printed, omega):
    for beta, alpha, d in STATES:
        outcome = step(printed, beta, alpha, d, 0.1, omega, SAMPLING_S)
        image = step(printed, -beta, -alpha, d, 0.1, -omega, SAMPLING_S)
        assert image == pytest.approx((-outcome[0], -outcome[1], outcome[2]), abs=1e-12)


@PLANTS
def test_one_step_is_the_integral_of_the_rates(printed):
    """Against many small Euler steps of beta' = +-(v/d) sin(alpha), alpha' = beta' - omega, d' = -v cos(alpha)."""
    sign, v, omega, parts = (-1.0 if printed else 1.0), 0.1, 0.17, 4000
    for state in STATES[:8]:
        beta, alpha, d = state
        for _ in range(parts):
            rate = sign * v / d * math.sin(alpha)
            beta, alpha, d = (
                beta + rate * SAMPLING_S / parts,
                alpha + (rate - omega) * SAMPLING_S / parts,
                d - v * math.cos(alpha) * SAMPLING_S / parts,
            )
        assert step(printed, *state, v, omega, SAMPLING_S) == pytest.approx((beta, alpha, d), abs=2e-5)


def test_the_compiled_plant_is_the_one_plant_of_the_repository():
    for beta, alpha, d in STATES:
        pose = plant.advance(*plant.pose(beta, alpha, d), 0.1, -0.1, SAMPLING_S)
        assert step(False, beta, alpha, d, 0.1, -0.1, SAMPLING_S) == pytest.approx(plant.observe(*pose), abs=1e-12)


@PLANTS
def test_a_mirrored_controller_docks_from_mirrored_starts_in_the_same_time(printed):
    """Starts away from the borders of cells, where rounding would decide."""
    table = np.random.default_rng(1).integers(0, 2, GRID.count).astype(np.int8)
    straight = times(STATES, table, printed=printed)
    image = times(STATES * (-1, -1, 1), (1 - table[::-1]).astype(np.int8), printed=printed)
    np.testing.assert_allclose(image, straight)


def slow_time(start, omega_of):
    """Docking time by the definition, in plain Python over the plant."""
    pose = plant.pose(*start)
    for k in range(4000):
        beta, alpha, d = plant.observe(*pose)
        cell = GRID.cell(beta, alpha)
        if cell == SINK or d < D_MIN_M:
            return math.inf
        if cell == GRID.goal:
            return k * SAMPLING_S
        pose = plant.advance(*pose, TASK.speed_mps, omega_of(cell, beta, alpha), SAMPLING_S)
    raise AssertionError


def test_docking_times_of_table_and_law_are_those_of_the_slow_twin():
    law = Linear(*BEST_TUNED, TASK.turn_rate_radps)
    table = teacher_table(law, GRID, TASK.actions)
    none = np.full(GRID.count, -1, dtype=np.int8)
    starts = np.random.default_rng(5).uniform((-0.8, -0.6, 1.0), (0.8, 0.6, 2.0), (60, 3))
    by_table = [slow_time(start, lambda cell, *_: ACTIONS[table[cell]][1]) for start in starts]
    by_law = [slow_time(start, lambda _, beta, alpha: law.omega_radps(beta, alpha)) for start in starts]
    np.testing.assert_array_equal(times(starts, table), by_table)
    np.testing.assert_array_equal(times(starts, none, (*BEST_TUNED, TASK.turn_rate_radps), keep=False), by_law)
    assert 10 < np.isfinite(by_law).sum() < 60


def slow_trial(start, table, reach):
    """Transitions by the definition."""
    pose, rows = plant.pose(*start), []
    beta, alpha, d = plant.observe(*pose)
    while True:
        cell, entered, n, before = GRID.cell(beta, alpha), None, 0, (beta, alpha)
        if cell in (SINK, GRID.goal):
            return rows
        action = table[cell]
        while entered is None:
            pose = plant.advance(*pose, *ACTIONS[action], SAMPLING_S)
            beta, alpha, d = plant.observe(*pose)
            n += 1
            now = GRID.cell(beta, alpha)
            if now in (SINK, GRID.goal) or d < D_MIN_M or GRID.distance(cell, now) >= reach:
                entered = now
        near = d < D_MIN_M and entered not in (SINK, GRID.goal)
        rows.append([cell, action, SINK if near else entered, n, beta - before[0], alpha - before[1], near])
        if near:
            return rows


@pytest.mark.parametrize("reach", [1, 2])
def test_the_transitions_of_a_trial_are_those_of_the_slow_twin(reach):
    table = np.random.default_rng(8).integers(0, 2, GRID.count).astype(np.int8)
    for start in STATES[:15]:
        rows, samples, reached = trial(start, table, reach=reach)
        expected = slow_trial(start, table, reach)
        np.testing.assert_allclose(rows, np.array(expected, dtype=float).reshape(-1, 7), atol=1e-12)
        assert samples == sum(row[3] for row in expected)
        assert reached == bool(expected and expected[-1][2] == GRID.goal)


@pytest.mark.parametrize("hold", [1, 4])
def test_with_a_fixed_hold_every_transition_but_the_last_takes_so_long(hold):
    rows, _, _ = trial(STATES[0], np.full(GRID.count, -1, dtype=np.int8), hold=hold)
    assert len(rows) > 3
    assert (rows[:-1, 3] == hold).all()
    assert rows[-1, 3] <= hold


def test_unknown_cells_are_explored_evenly_and_known_ones_as_often_as_asked():
    unknown, left = np.full(GRID.count, -1, dtype=np.int8), np.zeros(GRID.count, dtype=np.int8)
    actions = np.concatenate([trial((0.5, 0.2, 1.9), unknown, seed=s)[0][:, 1] for s in range(60)])
    assert actions.mean() == pytest.approx(0.5, abs=0.05)
    actions = np.concatenate([trial((0.5, 0.2, 1.9), left, explore=0.4, seed=s)[0][:, 1] for s in range(60)])
    assert actions.mean() == pytest.approx(0.2, abs=0.05)


def test_noise_changes_the_outcome_only_when_asked_for_and_repeats_with_its_seed():
    table = teacher_table(Linear(*BEST_TUNED, TASK.turn_rate_radps), GRID, TASK.actions)
    calm, noisy = times(STATES, table), times(STATES, table, noise=0.3, seed=1)
    np.testing.assert_array_equal(calm, times(STATES, table, seed=9))
    np.testing.assert_array_equal(noisy, times(STATES, table, noise=0.3, seed=1))
    assert (noisy != calm).any()
    rows = trial(STATES[1], table, percept_noise=0.01, seed=2)[0]
    np.testing.assert_array_equal(rows, trial(STATES[1], table, percept_noise=0.01, seed=2)[0])
