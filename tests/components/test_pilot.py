"""The pilot as a fold: who chooses, how a trial goes and ends, what changes nothing."""

import math

import numpy as np
import pytest

from components.pilot.component import Pilot
from components.pilot.ports import Params
from components.pilot.progress import Mode, Outcome, Phase
from docking.linear import BEST_TUNED, Linear, teacher_action
from runtime.contract import Event
from schemas.drive_pb2 import BaseState
from schemas.grasp_pb2 import Grasp
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import (
    AT_GOAL,
    DEG,
    FAR,
    PERIOD_NS,
    TASK,
    answers,
    drive,
    frame,
    percept,
    policy,
    tell,
)

LEARNING = Params(task=TASK, train_s=1e9, controller="rl")
EVALUATING = Params(task=TASK, train_s=0.0, evaluation_trials=3)


def test_the_numbers_of_modes_phases_and_outcomes_are_those_of_the_schema():
    for ours, theirs in ((Mode, Trial.Mode), (Phase, Trial.Phase), (Outcome, Trial.Outcome)):
        assert {word.name: int(word) for word in ours} == dict(theirs.items())


def test_an_action_is_held_until_the_cell_changes_and_only_then_another_is_drawn():
    said = [t.action for _, t in answers(Pilot(LEARNING, 1), range(100))]
    assert len(set(said)) == 1
    fresh = Pilot(Params(task=TASK, train_s=1e9, controller="rl", hold="sample"), 1)
    assert {t.action for _, t in answers(fresh, range(100))} == {0, 1}


def test_random_actions_are_fair_and_differ_from_trial_to_trial_and_seed_to_seed():
    actions = [answers(Pilot(LEARNING, seed), [0])[0][1].action for seed in range(200)]
    assert 70 <= sum(actions) <= 130


def test_rl_lc_takes_the_teacher_and_chance_in_turn():
    params = Params(train_s=1e9, controller="rl-lc")
    seen = list(drive(params, 1, (0.3, 0.2, 1.7), 2000))
    by_trial = {}
    for s in seen:
        if s.trial.mode == Trial.APPROACH and s.trial.action >= 0:
            by_trial.setdefault(s.trial.number, set()).add(s.trial.controller)
    assert len(by_trial) >= 6
    assert all(said == ({"lc"} if n % 2 == 0 else {"random"}) for n, said in by_trial.items())


def test_the_teacher_is_asked_at_the_cells_centre():
    """A state whose own sign of the law is another than that of its cell's centre."""
    pilot = Pilot(Params(task=TASK, train_s=1e9, controller="lc"), 1)
    grid, law = pilot._rules.grid, Linear(*BEST_TUNED, TASK.turn_rate_radps)
    generator = np.random.default_rng(0)
    states = generator.uniform((-1.1, -1.3), (1.1, 1.3), (500, 2))
    differing = [
        (b, a)
        for b, a in states
        if (cell := grid.cell(b, a)) != grid.goal and law.omega_radps(b, a) * law.omega_radps(*grid.centre(cell)) < 0.0
    ]
    assert len(differing) >= 10
    for beta, alpha in differing:
        ((command, trial),) = answers(Pilot(pilot._rules.params, 1), [0], (beta, alpha, 0.3))
        assert trial.action == teacher_action(law, grid, grid.cell(beta, alpha), TASK.actions)
        assert command.omega_radps == TASK.actions[trial.action][1]


def test_greedy_follows_the_policy_and_asks_the_teacher_where_it_knows_nothing():
    pilot = Pilot(Params(task=TASK, train_s=1e9, controller="greedy"), 1)
    cell = pilot._rules.grid.cell(*FAR[:2])
    teacher = teacher_action(pilot._rules.teacher, pilot._rules.grid, cell, TASK.actions)
    tell(pilot, "policy", policy(1 - teacher))
    ((command, trial),) = answers(pilot, [0])
    assert (trial.controller, trial.action, trial.policy_version) == ("greedy", 1 - teacher, 1)
    assert command.omega_radps == (0.17, -0.17)[1 - teacher]
    holed = bytearray(bytes([1 - teacher]) * 25)
    holed[cell] = 255
    fresh = Pilot(pilot._rules.params, 1)
    tell(fresh, "policy", policy(action=bytes(holed)))
    ((_, trial),) = answers(fresh, [0])
    assert (trial.controller, trial.action) == ("lc", teacher)


def test_the_policy_is_frozen_when_the_evaluation_begins():
    pilot = Pilot(EVALUATING, 1)
    tell(pilot, "policy", policy(version=7))
    answers(pilot, [0])
    tell(pilot, "policy", policy(version=8), 1)
    assert answers(pilot, range(1, 5))[-1][1].policy_version == 7


@pytest.mark.parametrize(
    "bad",
    [
        {"action": bytes(24)},
        {"action": bytes([2]) * 25},
        {"value": [math.nan] * 25},
        {"value": []},
        {"action_v_mps": [0.1]},
        {"action_v_mps": [math.nan, 0.1]},
        {"action_v_mps": [99.0, 0.1]},
        {"action_omega_radps": [0.1, 1e6]},
        {"action_v_mps": [], "action_omega_radps": []},
        {"beta_cells": 4_000_000_000, "alpha_cells": 4_000_000_000},
        {"beta_range_rad": math.inf},
        {"alpha_range_rad": -1.0},
    ],
)
def test_a_policy_that_does_not_fit_itself_is_refused_and_the_old_one_kept(bad):
    pilot = Pilot(LEARNING, 1)
    tell(pilot, "policy", policy(version=3))
    tell(pilot, "policy", policy(version=4, **bad))
    assert pilot.refused == 1
    assert answers(pilot, [0])[0][1].policy_version == 3


@pytest.mark.parametrize(
    ("look", "outcome"),
    [
        ((66 * DEG, 0.0, 0.3), Trial.SINK),
        ((0.0, -81 * DEG, 0.3), Trial.SINK),
        ((0.3, 0.3, 61 * DEG), Trial.SINK),
        ((0.0, 0.0, 61 * DEG), Trial.SINK),
        ((0.0, 0.0, 0.3), Trial.REACHED),
    ],
)
def test_where_a_trial_ends(look, outcome):
    (_, before), (command, trial), (_, after) = answers(pilot := Pilot(LEARNING, 1), [0]) + answers(pilot, [1, 2], look)
    assert (before.ended, trial.ended, trial.outcome, trial.number) == (0, 1, outcome, 0)
    assert (command.v_mps, command.omega_radps) == (0.0, 0.0)
    assert (after.mode, after.number, after.outcome) == (Trial.REVERSE, 0, outcome)
    assert trial.goal_reached == (outcome == Trial.REACHED)


def test_the_bumper_ends_a_trial_as_collided_and_drives_back():
    pilot = Pilot(LEARNING, 1)
    answers(pilot, [0])
    command, trial, _ = frame(pilot, 1, percept(*FAR), BaseState(bumper=True))
    assert (trial.outcome, command.v_mps) == (Trial.COLLIDED, 0.0)
    command, trial, _ = frame(pilot, 2, percept(0.2, 0.0, 0.6), BaseState(bumper=True))
    assert trial.mode == Trial.REVERSE
    assert command.v_mps <= 0.0


def test_an_object_out_of_view_for_a_moment_pauses_the_trial_which_goes_on_with_the_same_action():
    pilot = Pilot(LEARNING, 1)
    ((before, trial),) = answers(pilot, [0])
    for k in range(1, 10):
        command, waiting, _ = frame(pilot, k, percept(*FAR, visible=False))
        assert (command.v_mps, command.omega_radps, waiting.mode, waiting.ended) == (0.0, 0.0, Trial.WAIT, 0)
    ((after, again),) = answers(pilot, [10])
    assert (after, again.mode, again.began_ns) == (before, Trial.APPROACH, trial.began_ns)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e9])
@pytest.mark.parametrize("field", ["slope", "pan_rad", "tilt_rad"])
@pytest.mark.parametrize("params", [LEARNING, EVALUATING])
def test_a_percept_with_one_absurd_number_is_not_seen(params, field, bad):
    pilot = Pilot(params, 1)
    answers(pilot, range(5))
    look = percept(*FAR)
    setattr(look, field, bad)
    command, trial, _ = frame(pilot, 5, look)
    assert (command.v_mps, command.omega_radps, trial.mode, trial.ended) == (0.0, 0.0, Trial.WAIT, 0)


def test_an_object_that_stays_out_of_view_is_lost_after_its_time_and_never_moves_the_robot():
    pilot = Pilot(EVALUATING, 1)
    said = [frame(pilot, k, percept(*FAR, visible=False))[:2] for k in range(140)]
    assert all((d.v_mps, d.omega_radps) == (0.0, 0.0) for d, _ in said)
    lost = next(k for k, (_, t) in enumerate(said) if t.outcome == Trial.LOST)
    assert EVALUATING.lost_s < lost * 0.125 <= EVALUATING.lost_s + 0.5
    assert said[lost + 1][1].place
    assert said[lost + 1][1].start == 1


def test_a_trial_that_takes_too_long_times_out_counted_from_its_first_sight():
    pilot = Pilot(Params(task=TASK, train_s=1e9, controller="rl", trial_timeout_s=10.0), 1)
    said = [frame(pilot, k, percept(*FAR, visible=k >= 40))[1] for k in range(130)]
    out = next(k for k, t in enumerate(said) if t.outcome == Trial.TIMED_OUT)
    assert 40 + 80 < out <= 40 + 82
    assert said[out].began_ns == 40 * PERIOD_NS


def servoed(params=EVALUATING):
    """A pilot that has just handed over to the grasper, and the next frame's number."""
    pilot = Pilot(params, 1)
    answers(pilot, range(3))
    for k in range(3, 30):
        _, trial, _ = frame(pilot, k, percept(*AT_GOAL))
        if trial.mode == Trial.GRASP:
            return pilot, k + 1
    raise AssertionError("never grasps")


@pytest.mark.parametrize(("picked", "outcome"), [(True, Trial.PICKED), (False, Trial.MISSED)])
def test_the_grasper_has_the_robot_until_it_is_done(picked, outcome):
    pilot, k = servoed()
    tell(pilot, "grasp", Grasp(stage=Grasp.LOWERING), k)
    command, trial, _ = frame(pilot, k, percept(*AT_GOAL))
    assert not command.engaged
    assert (trial.mode, trial.goal_reached) == (Trial.GRASP, True)
    tell(pilot, "grasp", Grasp(stage=Grasp.DONE, picked=picked), k)
    _, trial, _ = frame(pilot, k + 1, percept(*AT_GOAL))
    assert (trial.outcome, trial.ended) == (outcome, 1)
    _, trial, _ = frame(pilot, k + 2, percept(*AT_GOAL))
    assert (trial.place, trial.start) == (True, 1)


def test_a_grasp_that_was_done_before_does_not_count_and_one_that_never_ends_is_missed():
    pilot = Pilot(EVALUATING, 1)
    tell(pilot, "grasp", Grasp(stage=Grasp.DONE, picked=True), 0)
    answers(pilot, range(3))
    outcomes = [frame(pilot, k, percept(*AT_GOAL))[1].outcome for k in range(3, 400)]
    assert Trial.PICKED not in outcomes
    assert Trial.MISSED in outcomes


def test_a_base_that_coasts_past_the_goal_is_brought_back_before_the_grasp():
    pilot = Pilot(EVALUATING, 1)
    answers(pilot, range(3))
    frame(pilot, 3, percept(*AT_GOAL), BaseState(v_mps=0.1))
    past = (0.0, 0.0, AT_GOAL[2] + 3 * DEG)
    frame(pilot, 4, percept(*past), BaseState(v_mps=0.1))
    command, trial, _ = frame(pilot, 5, percept(*past), BaseState())
    assert trial.mode == Trial.SERVO
    assert command.v_mps < 0.0


def test_a_bumper_from_before_the_placement_does_not_end_the_next_trial():
    pilot = Pilot(EVALUATING, 1)
    answers(pilot, range(3))
    _, hit, _ = frame(pilot, 3, percept(*FAR), BaseState(bumper=True))
    _, placed, _ = frame(pilot, 4, percept(*FAR), BaseState(bumper=True))
    assert (hit.outcome, placed.place) == (Trial.COLLIDED, True)
    for k in range(5, 12):
        said = pilot.handle(Event(k * PERIOD_NS, "percept", percept(*FAR), k * PERIOD_NS))
    (trial,) = [output.message for output in said if output.port == "trial"]
    assert (trial.mode, trial.ended) == (Trial.APPROACH, 1)


def test_an_old_percept_just_after_a_placement_begins_no_trial():
    pilot = Pilot(EVALUATING, 1)
    _, first, _ = frame(pilot, 0, percept(*AT_GOAL))
    _, second, _ = frame(pilot, 1, percept(*AT_GOAL))
    assert (first.mode, second.mode, second.goal_reached) == (Trial.PLACE, Trial.WAIT, False)


def test_with_nothing_to_do_the_session_is_finished_at_once():
    pilot = Pilot(Params(train_s=0.0, evaluation_trials=0), 1)
    command, trial, ended = frame(pilot, 0, percept(*FAR))
    assert (trial.phase, command.engaged, ended) == (Trial.FINISHED, False, True)
    assert not frame(pilot, 1, percept(*FAR))[2]
