"""A pilot in the shadow says what its policy would do, and is obeyed by nobody; two compared policies take turns."""

import numpy as np
import pytest
from hypothesis import given, settings

from components.pilot.component import Pilot
from components.pilot.ports import Params
from docking.cells import Grid
from docking.policy import PolicyTable
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import AT_GOAL, FAR, TASK, answers, frame, percept, policy, tell
from tests.components.test_pilot_state import EVENTS, stream

SHADOW = Params(task=TASK, shadow=True)
LEFT, RIGHT = policy(everywhere=0), policy(everywhere=1)


def table(action: int) -> bytes:
    """A policy file that turns one way everywhere."""
    grid = Grid.of(TASK)
    cells = np.full(grid.count, action, np.int8)
    return PolicyTable(grid, cells, np.zeros(grid.count), TASK.actions).to_bytes()


def shadow(params=SHADOW, table=None):
    pilot = Pilot(params, 1)
    if table is not None:
        tell(pilot, "policy", table)
    return pilot


@settings(max_examples=60, deadline=None)
@given(steps=EVENTS)
def test_whatever_happens_a_shadow_is_never_engaged_and_ends_no_session(steps):
    pilot = shadow()
    for event in stream(steps):
        said = {output.port: output.message for output in pilot.handle(event)}
        assert set(said) in (set(), {"drive", "trial"})
        assert not said or not said["drive"].engaged
        assert not said or not said["trial"].place


@pytest.mark.parametrize(("told", "action"), [(LEFT, 0), (RIGHT, 1)])
def test_it_says_its_policys_action_wherever_the_object_is_seen(told, action):
    (drive, trial), *_ = answers(shadow(table=told), range(3))
    assert (trial.action, trial.controller, trial.mode) == (action, "greedy", Trial.APPROACH)
    assert drive.omega_radps == told.action_omega_radps[action]


def test_a_shadow_of_the_learner_takes_every_new_policy():
    pilot = shadow(table=LEFT)
    answers(pilot, range(3))
    tell(pilot, "policy", RIGHT)
    assert [trial.action for _, trial in answers(pilot, range(3, 5), (-0.4, 0.3, FAR[2]))] == [1, 1]


def test_it_says_nothing_where_it_sees_nothing():
    drive, trial, _ = frame(shadow(table=LEFT), 0, percept(*FAR, visible=False))
    assert (drive.v_mps, drive.omega_radps, trial.mode) == (0.0, 0.0, Trial.WAIT)


def test_in_the_goal_cell_it_would_servo():
    _, trial, _ = frame(shadow(table=LEFT), 0, percept(*AT_GOAL))
    assert (trial.mode, trial.controller) == (Trial.SERVO, "servo")


COMPARED = Params(task=TASK, train_s=0.0, evaluation_trials=40, placing_s=0.0, policy=table(0), rival_policy=table(1),
                  rival_controller="greedy", first_start=5, pick_up=False)  # fmt: skip


def trials(params, seed=1):
    """(number, side, action, start) of each trial; each ends at once by leaving the cells."""
    pilot, found, start = Pilot(params, seed), [], None
    for k in range(400):
        beside = (0.4, 0.3, FAR[2]) if k % 3 != 2 else (1.4, 0.3, FAR[2])
        _, trial, ended = frame(pilot, k, percept(*beside))
        start = trial.start if trial.place else start
        if trial.mode == Trial.APPROACH and trial.action >= 0 and (not found or found[-1][0] != trial.number):
            found.append((trial.number, trial.side, trial.action, start))
        if ended:
            break
    return found


def test_of_each_pair_of_trials_one_is_the_rivals_from_the_same_start():
    found = trials(COMPARED)
    assert [number for number, *_ in found] == list(range(40))
    for first, second in zip(found[::2], found[1::2], strict=True):
        assert {first[1], second[1]} == {"a", "b"}
        assert first[3] == second[3] == 5 + first[0] // 2


def test_each_side_is_driven_by_its_own_policy():
    assert {(side, action) for _, side, action, _ in trials(COMPARED)} == {("a", 0), ("b", 1)}


def test_the_order_in_the_pairs_comes_from_the_seed_and_favours_nobody():
    orders = {seed: "".join(side for _, side, _, _ in trials(COMPARED, seed)[::2]) for seed in range(6)}
    assert trials(COMPARED, 3) == trials(COMPARED, 3)
    assert len(set(orders.values())) > 1
    assert 0.3 < sum(order.count("a") for order in orders.values()) / 120 < 0.7


def test_without_a_rival_no_trial_has_a_side():
    params = Params(task=TASK, train_s=0.0, evaluation_trials=2, placing_s=0.0, policy=table(0))
    assert {side for _, side, _, _ in trials(params)} == {""}


def test_a_robot_that_nobody_places_drives_back_itself_between_evaluation_trials():
    params = Params(task=TASK, train_s=0.0, evaluation_trials=3, policy=table(0), evaluation_reset="reverse")
    pilot = Pilot(params, 1)
    seen = [frame(pilot, k, percept(*FAR))[:2] for k in range(3)]
    assert [trial.mode for _, trial in seen] == [Trial.APPROACH] * 3
    frame(pilot, 3, percept(1.4, 0.3, FAR[2]))
    drive, trial, _ = frame(pilot, 4, percept(0.2, 0.1, AT_GOAL[2] - 0.1))
    assert (trial.mode, trial.place, drive.v_mps < 0.0) == (Trial.REVERSE, False, True)
