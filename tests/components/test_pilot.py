"""The pilot as a fold: one answer per frame, never a motion without a reason, everything in its state."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.pilot.component import Pilot
from components.pilot.ports import Params
from components.pilot.progress import Mode, Outcome, Phase
from docking.linear import BEST_TUNED, Linear, teacher_action
from docking.task import Task
from runtime.contract import STOP, Event
from schemas.drive_pb2 import BaseState
from schemas.grasp_pb2 import Grasp
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import DEG, HEIGHT_M, PERIOD_NS, drive, frame, percept

TASK = Task(beta_cells=5, alpha_cells=5)
LEARNING = Params(task=TASK, train_s=1e9, controller="rl")
EVALUATING = Params(task=TASK, train_s=0.0, evaluation_trials=3)
FAR = (0.4, 0.3, math.atan2(HEIGHT_M, 1.5))
AT_GOAL = (0.0, 0.0, Task().goal_tilt_rad)


def policy(everywhere=0, **changes):
    table = {
        "version": 1, "beta_cells": 5, "alpha_cells": 5, "beta_range_rad": TASK.beta_range_rad,
        "alpha_range_rad": TASK.alpha_range_rad, "action": bytes([everywhere]) * 25, "value": [0.0] * 25,
        "action_v_mps": [0.1, 0.1], "action_omega_radps": [0.17, -0.17],
    }  # fmt: skip
    return Policy(**{**table, **changes})


def tell(pilot, port, message, k=0):
    return pilot.handle(Event(k * PERIOD_NS, port, message, k * PERIOD_NS))


def answers(pilot, frames, look=FAR):
    """(drive, trial) of each of these frames."""
    return [frame(pilot, k, percept(*look))[:2] for k in frames]


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
    assert (said[1].message.mode, said[1].message.ended) == (Trial.APPROACH, 1)


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


ANY = st.floats(allow_nan=True, allow_infinity=True)
SANE = st.tuples(st.floats(-1.4, 1.4), st.floats(-1.7, 1.7), st.floats(0.05, 1.4))
PERCEPTS = st.one_of(
    st.builds(Percept, visible=st.booleans(), slope=ANY, pan_rad=ANY, tilt_rad=ANY),
    SANE.map(lambda s: percept(*s)),
    SANE.map(lambda s: percept(*s, visible=False)),
    st.just(percept(*AT_GOAL)),
)
BASES = st.builds(BaseState, v_mps=ANY, omega_radps=ANY, bumper=st.booleans())
GRASPS = st.builds(Grasp, stage=st.sampled_from(Grasp.Stage.values()), picked=st.booleans())
EVENTS = st.lists(
    st.tuples(st.integers(0, 40), st.one_of(PERCEPTS, PERCEPTS, PERCEPTS, BASES, GRASPS, st.just(policy()))),
    max_size=60,
)
PORTS = {Percept: "percept", BaseState: "base", Grasp: "grasp", Policy: "policy"}
QUICK = Params(
    task=TASK, train_s=8.0, evaluation_trials=3, controller="rl-lc", lost_s=1.0, trial_timeout_s=2.0,
    reverse_timeout_s=2.0, grasp_timeout_s=2.0,
)  # fmt: skip


def stream(steps):
    """Events whose capture times repeat, jump and sometimes lie in the past."""
    now, events = 0, []
    for step, message in steps:
        now = max(0, now + (step - 5) * PERIOD_NS // 4)
        events.append(Event(1000 * PERIOD_NS, PORTS[type(message)], message, now))
    return events


@settings(max_examples=150, deadline=None)
@given(steps=EVENTS)
def test_every_new_frame_is_answered_once_and_nothing_moves_without_a_sight_of_the_object(steps):
    pilot, newest = Pilot(QUICK, 1), -1
    for event in stream(steps):
        said = pilot.handle(event)
        if event.port != "percept" or event.capture_ns <= newest:
            assert said == ()
            continue
        newest = event.capture_ns
        assert [o.port for o in said[:2]] == ["drive", "trial"]
        assert {o.port for o in said[2:]} <= {"end"}
        command, look = said[0].message, event.message
        moves = (command.v_mps, command.omega_radps) != (0.0, 0.0)
        assert abs(command.v_mps) <= 0.2
        assert abs(command.omega_radps) <= QUICK.reverse_turn_rate_radps
        if not (look.visible and abs(look.slope) < 1e3 and abs(look.pan_rad) < 3.2 and 0.0 < look.tilt_rad < 1.58):
            assert not moves
        if said[1].message.mode in (Trial.WAIT, Trial.PLACE, Trial.GRASP):
            assert not moves


@settings(max_examples=60, deadline=None)
@given(steps=EVENTS, cut=st.integers(0, 60))
def test_cut_saved_and_loaded_into_a_fresh_pilot_the_remaining_bytes_are_the_same(steps, cut):
    events = stream(steps)
    whole, first, second = Pilot(QUICK, 1), Pilot(QUICK, 1), Pilot(QUICK, 1)
    for event in events[:cut]:
        whole.handle(event)
        first.handle(event)
    second.load(first.save())
    for event in events[cut:]:
        assert spoken(second, event) == spoken(whole, event)
    assert second.save() == whole.save()


def spoken(pilot, event):
    return [(o.port, o.message.SerializeToString(deterministic=True)) for o in pilot.handle(event)]


def test_a_session_cut_anywhere_goes_on_with_the_same_bytes():
    """On the plant: through choices, ends of trials and reverses."""
    params = Params(train_s=60.0, evaluation_trials=2, evaluation_controller="lc", pick_up=False)
    seen = list(drive(params, 1, (0.3, 0.2, 1.7), 900, starts=lambda n: (0.2, 0.1, 1.6)))
    pilot = Pilot(params, 1)
    for k, s in enumerate(seen):
        if k % 7 == 0:
            state = pilot.save()
            pilot = Pilot(params, 1)
            pilot.load(state)
        before = seen[k - 1].drive if k else seen[0].drive.__class__()
        look = percept(s.beta_rad, s.alpha_rad, math.atan2(HEIGHT_M, s.d_m))
        command, trial, _ = frame(pilot, k, look, BaseState(v_mps=before.v_mps, omega_radps=before.omega_radps))
        assert (command, trial) == (s.drive, s.trial)


@pytest.mark.parametrize(
    "state",
    [
        b"", b"{}", b"null", b"[]", b'{"session": "{}", "policy": null}', b'{"session": 3, "policy": null}', b"\xff",
        Pilot(QUICK, 1).save().replace(b'\\"mode\\": 0', b'\\"mode\\": 9'),
        Pilot(QUICK, 1).save().replace(b'\\"number\\": 0', b'\\"number\\": 0.5'),
        Pilot(QUICK, 1).save().replace(b'\\"tilt_rad\\": 0.2', b'\\"tilt_rad\\": NaN'),
        Pilot(QUICK, 1).save().replace(b'"policy": null', b'"policy": "AAAA"'),
    ],
)  # fmt: skip
def test_a_state_that_is_none_is_refused_and_the_pilot_stays_as_it_was(state):
    pilot = Pilot(QUICK, 1)
    answers(pilot, range(5))
    before = pilot.save()
    with pytest.raises(ValueError):  # noqa: PT011
        pilot.load(state)
    assert pilot.save() == before


def test_the_stop_is_taken_in_silence():
    assert Pilot(QUICK, 1).handle(Event(0, STOP)) == ()
