"""What the pilot says of a start before it moves, against what becomes of it on a perfect plant."""

import math

import numpy as np
import pytest

from components.pilot.forecast import arrivals_s, forecast
from components.pilot.ports import Params
from components.pilot.rules import Rules
from docking import plant
from docking.cells import Grid
from docking.policy import PolicyTable
from tests.components.piloting_world import HEIGHT_M, drive
from tests.components.test_pilot_fine import docked, ends, planned, task

HOME = (0.3, 0.2, 1.7)
HOPELESS = ((0.5, 1.0), (0.7, 0.3), (0.2, 1.2))
"""(beta, alpha) of starts from 1 m away; so are their mirror images."""


def spread(count, seed=5):
    rng = np.random.default_rng(seed)
    return [tuple(start) for start in rng.uniform((-1.1, -1.3, 1.0), (1.1, 1.3, 2.0), (count, 3)).tolist()]


def expected(action_set, start):
    beta, alpha, d = start
    rules = Rules.of(Params(task=task(action_set)), 1)
    fine = PolicyTable.from_bytes(planned(action_set)).fine
    return forecast(rules, fine, np.array([[beta, alpha, math.log(d / HEIGHT_M)]]))


@pytest.mark.parametrize("action_set", ["one-speed", "two-speeds"])
def test_what_is_forecast_comes_about(action_set):
    starts = spread(15)
    trials = ends(action_set, starts)
    told = [next(seen.trial for seen in trial if seen.trial.dock_share > 0.0) for trial in trials]
    came = [docked(trial[-1]) for trial in trials]
    brier = np.mean([(trial.dock_share - end) ** 2 for trial, end in zip(told, came, strict=True)])
    assert brier < 0.1
    for trial, frames, end in zip(told, trials, came, strict=True):
        if end and trial.dock_share > 0.8:
            took_s = (frames[-1].time_ns - trial.began_ns) * 1e-9
            assert took_s == pytest.approx(trial.dock_s, abs=4.0)


def test_it_is_said_before_the_robot_moves_and_stays_until_the_next_trial():
    starts = spread(2)
    for trial in ends("two-speeds", starts):
        first = next(k for k, seen in enumerate(trial) if seen.drive.v_mps != 0.0)
        told = {(seen.trial.dock_share, seen.trial.dock_s) for seen in trial[first:]}
        assert len(told) == 1
        assert 0.0 < told.pop()[0] < 1.0


def test_a_start_that_is_hopeless_is_told_how_far_back_to_go_and_from_there_it_mostly_docks():
    near = [
        (side * beta, side * alpha, 1.0) for side in (-1, 1) for beta, alpha in ((0.5, 1.0), (0.7, 0.3), (0.2, 1.2))
    ]
    told = [expected("one-speed", start) for start in near]
    assert all(forecast.share < 0.2 for forecast in told)
    assert all(forecast.back_off_m > 0.0 for forecast in told)
    poses = [plant.advance(*plant.pose(*start), -f.back_off_m, 0.0, 1.0) for start, f in zip(near, told, strict=True)]
    far = [plant.observe(*pose) for pose in poses]
    assert not any(docked(trial[-1]) for trial in ends("one-speed", near))
    assert sum(docked(trial[-1]) for trial in ends("one-speed", far)) >= 4


def test_a_robot_that_can_back_up_needs_no_such_advice():
    assert expected("reverse", (0.5, 1.0, 1.0)).share > 0.5
    assert expected("reverse", (0.5, 1.0, 1.0)).back_off_m == 0.0


def test_a_state_that_is_no_number_is_hopeless_and_takes_no_time():
    rules = Rules.of(Params(task=task("one-speed")), 1)
    fine = PolicyTable.from_bytes(planned("one-speed")).fine
    assert np.isinf(arrivals_s(rules, fine, np.array([[math.nan, 0.0, 0.0], [0.0, math.inf, 0.0]]))).all()


def test_a_policy_of_cells_forecasts_nothing():
    goal = task("one-speed")
    grid = Grid.of(goal)
    cells = PolicyTable(grid, np.zeros(grid.count, np.int8), np.ones(grid.count), goal.actions).to_bytes()
    params = Params(task=goal, train_s=0.0, evaluation_trials=1, policy=cells)
    assert {seen.trial.dock_share for seen in drive(params, 1, HOME, 40, starts=lambda _: HOME)} == {0.0}
