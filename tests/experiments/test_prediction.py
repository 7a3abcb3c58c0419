"""What a log predicts of itself, on a corridor whose answer is known."""

import math
from dataclasses import replace

import numpy as np
import pytest

from components.learner.ports import Params
from components.learner.transition import Transition
from docking.cells import Grid
from docking.policy import PolicyTable
from docking.task import Task
from experiments.logged_trials import LoggedTrial
from experiments.prediction import predict

PARAMS = Params(task=Task(beta_cells=5, alpha_cells=5), model="exits", mirror=False)
GRID = Grid.of(PARAMS.task)
GOAL = GRID.goal
CORRIDOR = [GOAL - 2, GOAL - 1, GOAL]
"""Cells of the middle row, from its end to the goal."""


def step(cell: int, entered: int, action: int = 0, periods: float = 4.0) -> Transition:
    return Transition(cell, action, entered, periods, 0.0, 0.1, periods)


def docking() -> LoggedTrial:
    return LoggedTrial([step(CORRIDOR[0], CORRIDOR[1]), step(CORRIDOR[1], GOAL)], frames=8)


def failing() -> LoggedTrial:
    return LoggedTrial([step(CORRIDOR[0], -1, action=1)], frames=4)


def policy(action: int) -> PolicyTable:
    actions = np.full(GRID.count, -1, dtype=np.int8)
    actions[CORRIDOR[:2]] = action
    return PolicyTable(GRID, actions, np.zeros(GRID.count), PARAMS.task.actions)


def test_a_log_that_always_does_the_same_is_predicted_without_error():
    found = predict(PARAMS, [docking()] * 10, policy(0))
    assert (found.trials, found.transitions) == (10, 20)
    assert found.known_percent == 100.0
    assert found.one_step_error == pytest.approx(0.0, abs=1e-6)
    assert found.outcome_error == pytest.approx(0.0, abs=1e-6)
    assert found.duration_error_s == pytest.approx(0.0, abs=1e-6)
    assert found.agreement_percent == 100.0
    assert found.controllable_percent == pytest.approx(100.0 * 3 / GRID.count)


def test_an_even_mixture_is_wrong_by_half():
    trials = [trial for _ in range(50) for trial in (docking(), failing())]
    found = predict(PARAMS, trials, policy(0))
    assert found.outcome_error == pytest.approx(0.5, abs=0.01)
    assert found.one_step_error == pytest.approx(0.0, abs=1e-6)
    assert found.agreement_percent == pytest.approx(100.0 * 2 / 3)


def test_exits_at_random_are_wrong_as_often_as_chance_says():
    odd, even = LoggedTrial([step(CORRIDOR[0], GOAL - 1)], 4), LoggedTrial([step(CORRIDOR[0], GOAL - 6)], 4)
    assert predict(PARAMS, [odd, even] * 50, policy(0)).one_step_error == pytest.approx(0.5, abs=0.01)


def test_the_duration_is_wrong_by_the_spread_of_durations():
    slow = LoggedTrial([step(CORRIDOR[0], CORRIDOR[1], periods=12.0), step(CORRIDOR[1], GOAL)], frames=16)
    found = predict(PARAMS, [docking(), slow] * 50, policy(0))
    assert found.duration_error_s == pytest.approx(4 * PARAMS.sampling_period_s, rel=0.05)


def test_a_policy_that_leads_elsewhere_controls_nothing_but_the_goal():
    trials = [trial for _ in range(50) for trial in (docking(), failing())]
    assert predict(PARAMS, trials, policy(1)).controllable_percent == pytest.approx(100.0 / GRID.count)


def test_a_mirrored_log_knows_the_mirrored_corridor():
    found = predict(replace(PARAMS, mirror=True), [docking()] * 10, policy(0))
    mirrored = np.full(GRID.count, -1, dtype=np.int8)
    for cell in CORRIDOR[:2]:
        mirrored[cell], mirrored[GRID.mirrored(cell)] = 0, 1
    both = PolicyTable(GRID, mirrored, np.zeros(GRID.count), PARAMS.task.actions)
    assert found.controllable_percent == pytest.approx(100.0 * 3 / GRID.count)
    both_ways = predict(replace(PARAMS, mirror=True), [docking()] * 10, both)
    assert both_ways.controllable_percent == pytest.approx(100.0 * 5 / GRID.count)


def test_an_empty_log_predicts_nothing():
    found = predict(PARAMS, [], None)
    assert found.trials == found.transitions == 0
    assert math.isnan(found.one_step_error)
    assert math.isnan(found.controllable_percent)


def test_a_trial_is_never_predicted_from_itself():
    apart = [LoggedTrial([step(cell, cell + 1)], 4) for cell in (0, 1, 5, 6, 15, 16, 20, 21)]
    assert predict(PARAMS, apart, None).known_percent == 0.0


def test_a_mirrored_trial_takes_as_long_as_its_image():
    image = [GRID.mirrored(cell) for cell in CORRIDOR]
    mirrored = LoggedTrial([step(image[0], image[1], action=1), step(image[1], GOAL, action=1)], frames=8)
    found = predict(replace(PARAMS, mirror=True), [*[docking()] * 9, mirrored], None)
    assert found.known_percent == 100.0
    assert found.duration_error_s == pytest.approx(0.0, abs=1e-6)
