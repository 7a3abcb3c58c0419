"""The pilot under any sequence of events: one answer per frame, no motion without a reason, everything in its state."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.pilot.component import Pilot
from components.pilot.ports import Params
from runtime.contract import STOP, Event
from schemas.drive_pb2 import BaseState
from schemas.grasp_pb2 import Grasp
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import (
    AT_GOAL,
    HEIGHT_M,
    PERIOD_NS,
    TASK,
    answers,
    drive,
    frame,
    percept,
    policy,
)

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
def test_every_new_frame_is_answered_once_and_unseen_nothing_moves_but_the_search_on_the_spot(steps):
    pilot, newest = Pilot(QUICK, 1), -1
    for event in stream(steps):
        said = pilot.handle(event)
        if event.port != "percept" or event.capture_ns <= newest:
            assert said == ()
            continue
        newest = event.capture_ns
        assert sorted(o.port for o in said if o.port != "end") == ["drive", "trial"]
        answer = {o.port: o.message for o in said}
        command, look = answer["drive"], event.message
        moves = (command.v_mps, command.omega_radps) != (0.0, 0.0)
        assert abs(command.v_mps) <= 0.2
        assert abs(command.omega_radps) <= QUICK.reverse_turn_rate_radps
        if not (look.visible and abs(look.slope) < 1e3 and abs(look.pan_rad) < 3.2 and 0.0 < look.tilt_rad < 1.58):
            assert command.v_mps == 0.0
            assert not moves or (answer["trial"].mode, answer["trial"].controller) == (Trial.REVERSE, "search")
        if answer["trial"].mode in (Trial.WAIT, Trial.PLACE, Trial.GRASP):
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
