from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest

from components.learner.component import Learner
from components.learner.methods import METHODS
from components.learner.ports import Params
from docking.cells import Grid
from docking.policy import PolicyTable
from docking.task import Task
from runtime.contract import STOP, Event
from schemas.drive_pb2 import Applied
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Snapshot
from schemas.trial_pb2 import Trial
from tests.components.learning_world import session

TASK = Task(beta_cells=15, alpha_cells=15)
PARAMS = Params(task=TASK, delay_samples=0, snapshot_every_trials=2)


def play(learner, events):
    return [
        (output.port, output.message.SerializeToString(deterministic=True), output.capture_ns)
        for event in events
        for output in learner.handle(event)
    ]


def recorded(trials=6, **world):
    return list(itertools.chain.from_iterable(session(TASK, trials, **world)))


def newest_policy(outputs):
    return Policy.FromString([data for port, data, _ in outputs if port == "policy"][-1])


def test_every_transition_that_counts_is_followed_by_one_policy_of_the_next_version():
    outputs = play(Learner(PARAMS, 0), recorded())
    policies = [Policy.FromString(data) for port, data, _ in outputs if port == "policy"]
    assert len(policies) > 30
    assert [policy.version for policy in policies] == list(range(1, len(policies) + 1))
    assert [policy.transitions for policy in policies] == list(range(1, len(policies) + 1))
    frames = [capture_ns for port, _, capture_ns in outputs if port == "policy"]
    assert len(set(frames)) == len(frames)


def test_a_published_policy_is_a_valid_symmetric_table_over_the_cells_of_the_task():
    policy = newest_policy(play(Learner(PARAMS, 0), recorded()))
    table = PolicyTable(
        Grid.of(TASK),
        np.frombuffer(policy.action, dtype=np.int8),
        np.array(policy.value),
        tuple(zip(policy.action_v_mps, policy.action_omega_radps, strict=True)),
    )
    assert (policy.beta_cells, policy.alpha_cells) == (15, 15)
    assert table.actions == TASK.actions
    assert table.known > 60
    assert table.mirror_faults == 0


def test_what_was_asked_for_does_not_matter_only_what_was_applied():
    events = recorded(3)
    for event in events:
        if event.port == "trial":
            event.message.action = 1
            event.message.controller = "random"
    assert newest_policy(play(Learner(PARAMS, 0), events)) == newest_policy(play(Learner(PARAMS, 0), recorded(3)))
    for event in events:
        if event.port == "applied":
            event.message.omega_radps = -event.message.omega_radps
    assert newest_policy(play(Learner(PARAMS, 0), events)) != newest_policy(play(Learner(PARAMS, 0), recorded(3)))


def test_the_order_in_which_the_parts_of_a_frame_arrive_does_not_matter():
    shuffled = [event for frame in session(TASK, 6) for event in (frame[2], frame[0], frame[1])]
    assert newest_policy(play(Learner(PARAMS, 0), shuffled)) == newest_policy(play(Learner(PARAMS, 0), recorded()))


@pytest.mark.parametrize("mode", [Trial.WAIT, Trial.SERVO, Trial.GRASP, Trial.REVERSE, Trial.PLACE])
def test_nothing_is_learned_outside_the_approach(mode):
    events = recorded(2)
    for event in events:
        if event.port == "trial":
            event.message.mode = mode
    assert play(Learner(PARAMS, 0), events) == []


def test_nothing_is_learned_in_the_evaluation_and_the_training_ends_with_a_snapshot():
    learner = Learner(dataclasses.replace(PARAMS, snapshot_every_trials=1000), 0)
    outputs = play(learner, recorded(2))
    assert {port for port, _, _ in outputs} == {"policy"}
    later = recorded(4)[len(recorded(2)) :]
    for event in later:
        if event.port == "trial":
            event.message.phase = Trial.EVALUATE
    assert [port for port, _, _ in play(learner, later)] == ["snapshot"]


def test_snapshots_come_at_the_end_of_every_second_trial_and_restore_the_learner():
    events = recorded(6)
    outputs = play(Learner(PARAMS, 0), events)
    snapshots = [(place, data, ns) for place, (port, data, ns) in enumerate(outputs) if port == "snapshot"]
    assert len(snapshots) == 2
    place, data, frame_ns = snapshots[0]
    snapshot = Snapshot.FromString(data)
    learner = Learner(PARAMS, 5)
    learner.load(snapshot.state)
    later = [event for event in events if event.capture_ns > frame_ns]
    assert play(learner, later) == outputs[place + 1 :]


def test_the_end_of_the_run_saves_what_is_new_and_only_that():
    learner = Learner(PARAMS, 0)
    play(learner, recorded(1))
    stop = Event(10**12, STOP)
    assert [output.port for output in learner.handle(stop)] == ["snapshot"]
    assert learner.handle(stop) == ()


@pytest.mark.parametrize("cut", [1, 100, 101, 350])
@pytest.mark.parametrize("method", METHODS)
def test_cut_saved_and_loaded_the_remaining_bytes_are_the_same(method, cut):
    params = dataclasses.replace(PARAMS, method=method)
    events = recorded(3)
    whole = Learner(params, 0)
    play(whole, events[:cut])
    again = Learner(params, 1)
    again.load(whole.save())
    assert again.save() == whole.save()
    rest = play(whole, events[cut:])
    assert rest
    assert play(again, events[cut:]) == rest


@pytest.mark.parametrize("state", [b"", b"x" * 100, Learner(dataclasses.replace(PARAMS, mirror=False), 0).save()])
def test_a_state_that_is_none_or_another_learners_is_refused_and_changes_nothing(state):
    learner = Learner(PARAMS, 0)
    play(learner, recorded(1))
    before = learner.save()
    with pytest.raises(ValueError, match="learner"):
        learner.load(state)
    assert learner.save() == before


HOSTILE = [math.nan, math.inf, -math.inf, 1e300, -1e300]


@pytest.mark.parametrize("value", HOSTILE)
def test_absurd_numbers_are_no_transition_and_no_crash(value):
    learner = Learner(PARAMS, 0)
    messages = {
        "percept": Percept(visible=True, slope=value, pan_rad=value, tilt_rad=value),
        "trial": Trial(phase=Trial.TRAIN, mode=Trial.APPROACH, began_ns=-5, number=2**31),
        "applied": Applied(v_mps=value, omega_radps=value),
    }
    for k in range(50):
        for port, message in messages.items():
            assert learner.handle(Event(k * 125_000_000, port, message, k * 125_000_000)) == ()


def test_lost_parts_cost_no_more_than_the_transitions_around_them():
    events = recorded(6)
    holes = [event for place, event in enumerate(events) if place % 40 != 25]
    whole = newest_policy(play(Learner(PARAMS, 0), events)).transitions
    assert 0.8 * whole < newest_policy(play(Learner(PARAMS, 0), holes)).transitions <= whole


def test_a_flood_of_single_parts_is_bounded():
    learner = Learner(PARAMS, 0)
    for k in range(20_000):
        learner.handle(Event(k, "percept", Percept(), k))
    assert len(learner.save()) < 100_000


def test_learning_over_the_bus_equals_learning_from_the_same_transitions_off_it():
    """Values from messages and from the transitions cut by hand differ by rounding alone."""
    from components.learner.methods import make_method  # noqa: PLC0415
    from components.learner.transition import Transition  # noqa: PLC0415

    learner, method, grid = Learner(PARAMS, 0), make_method(TASK, PARAMS), Grid.of(TASK)
    hold = None
    for frame in session(TASK, 6):
        play(learner, frame)
        percept, trial, applied = (event.message for event in frame)
        if trial.mode != Trial.APPROACH:
            hold = None
            continue
        beta, alpha, _, close = TASK.seen(percept.slope, percept.pan_rad, percept.tilt_rad)
        cell = -1 if close else grid.cell(beta, alpha)
        if hold is not None and cell != hold[0]:
            n = frame[0].sequence - hold[4]
            seen = Transition(hold[0], hold[3], cell, n, beta - hold[1], alpha - hold[2], n, close)
            if method.observe(seen):
                method.plan()
            hold = None
        if hold is None and cell not in (-1, grid.goal):
            action = 0 if applied.omega_radps > 0 else 1
            hold = (cell, beta, alpha, action, frame[0].sequence)
    assert method.transitions == learner._method.transitions > 30
    np.testing.assert_allclose(learner._method.q, method.q, atol=1e-9)


def test_with_a_delayed_and_noisy_robot_the_turn_rates_learned_are_the_true_ones():
    """On average over the cells the bearing changes by the turn rate; half a frame of wrong motion would show."""
    params = dataclasses.replace(PARAMS, delay_samples=1)
    learner = Learner(params, 0)
    for frame in session(TASK, 120, noise_rad=0.012, delay=1):
        for event in frame:
            learner.handle(event)
    model = learner._method.model
    tried = model.visits >= 3
    rates = model.mean[:, 1] / np.maximum(model.mean[:, 2], 1e-9) * (2 * TASK.alpha_range_rad / 15) / 0.125
    left, right = rates[0::2][tried[0::2]], rates[1::2][tried[1::2]]
    assert np.median(left) == pytest.approx(-TASK.turn_rate_radps, rel=0.08)
    assert np.median(right) == pytest.approx(TASK.turn_rate_radps, rel=0.08)
