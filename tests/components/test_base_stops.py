"""Every reason for the base to stop, on its own clock."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.base.component import Base
from components.base.ports import Params
from runtime.contract import Event
from schemas.drive_pb2 import BaseState, Drive
from tests.components.test_base import FRAME, GO, IDLE, MS, applied, hand, motion

REAL = Params(clock="real", commanders=("pilot",), stop_when_gone=("tracker", "pilot"))
BACK = Drive(engaged=True, v_mps=-0.1)


def ticks(base, first_ms, last_ms):
    """(ms, output) of what is said on the 50 Hz ticks in [first, last]."""
    return [
        (ms, said)
        for ms in range(first_ms, last_ms + 1, 20)
        if (said := base.handle(Event(ms * MS, "tick", None, ms * MS)))
    ]


def driving(params=REAL):
    """A base that drives on the frame captured at 1000 ms."""
    base = Base(params, 0)
    assert motion(hand(base, "pilot", GO, 1000 * MS, 1050 * MS)) == (0.1, 0.17, "pilot")
    return base


def test_without_a_newer_frame_the_robot_stops_within_300_ms_of_the_last_ones_capture():
    said = ticks(driving(), 1060, 1700)
    assert 1260 <= said[0][0] <= 1280, "a tick before it would be too late"
    assert all(motion(output) == (0.0, 0.0, "stale") for _, output in said)


@pytest.mark.parametrize("phase_ms", [0, 7, 19])
def test_a_late_answer_moves_the_robot_no_longer_than_its_frame_is_young(phase_ms):
    moved = 0
    for age_ms in range(240, 330):
        base = driving()
        if motion(hand(base, "pilot", GO, 1100 * MS, (1100 + age_ms) * MS))[2] == "pilot":
            moved += 1
            first_ms = 1100 + age_ms - (age_ms + phase_ms) % 20 + 20
            assert ticks(base, first_ms, 1500)[0][0] < 1400, age_ms
    assert moved > 20, "an answer that can still be ended in time does move it"


def test_the_stop_is_said_once_and_repeated_every_tenth_of_a_second():
    at = [ms for ms, _ in ticks(driving(), 1060, 2060)]
    assert at == list(range(1280, 2061, 100))


def test_fresh_frames_never_meet_a_stop():
    base = Base(REAL, 0)
    for k in range(100):
        ms = 125 * k
        assert not ticks(base, ms, ms + 60)
        assert motion(hand(base, "pilot", GO, ms * MS, (ms + 60) * MS))[2] == "pilot"
        assert not ticks(base, ms + 80, ms + 120)


def test_a_base_that_was_never_commanded_has_nothing_to_stop():
    assert not ticks(Base(REAL, 0), 0, 5000)


def test_a_burst_of_55_commands_up_to_3_s_old_moves_nothing():
    base = driving()
    now = 5000 * MS
    for k in range(55):
        capture = now - 3000 * MS + k * 48 * MS
        v, omega, commander = motion(hand(base, "pilot", GO, capture, now))
        assert ((v, omega) == (0.0, 0.0)) == (now - capture > 300 * MS)
        assert commander == ("stale" if now - capture > 300 * MS else "pilot")


def test_after_a_stop_a_fresh_frame_moves_the_robot_again():
    base = driving()
    ticks(base, 1060, 1500)
    assert motion(hand(base, "pilot", GO, 1500 * MS, 1550 * MS)) == (0.1, 0.17, "pilot")
    assert not ticks(base, 1560, 1760)


def test_a_person_who_falls_silent_keeps_the_robot_at_rest_until_he_gives_it_back():
    base = Base(REAL, 0)
    hand(base, "teleop", GO, 1000 * MS)
    assert motion(hand(base, "pilot", BACK, 1125 * MS)) == (0.1, 0.17, "teleop")
    for ms in range(1375, 5000, 125):
        assert motion(hand(base, "pilot", BACK, ms * MS)) == (0.0, 0.0, "stale")
    hand(base, "teleop", IDLE, 5000 * MS)
    assert motion(hand(base, "pilot", BACK, 5125 * MS)) == (-0.1, 0.0, "pilot")


def test_the_death_of_a_component_that_is_needed_stops_the_robot_at_once():
    base = driving()
    assert base.handle(Event(1060 * MS, "gone", "viewer")) == ()
    assert motion(base.handle(Event(1060 * MS, "gone", "tracker"))) == (0.0, 0.0, "gone")


def test_a_frame_captured_before_the_death_moves_nothing_one_after_it_does():
    base = driving()
    base.handle(Event(1200 * MS, "gone", "tracker"))
    assert hand(base, "pilot", GO, 1125 * MS, 1210 * MS) == ()
    assert motion(hand(base, "pilot", GO, 1250 * MS, 1300 * MS)) == (0.1, 0.17, "pilot")


def test_the_bumper_lets_the_robot_back_off_only():
    base = driving()
    hand(base, "device", BaseState(bumper=True), 1060 * MS)
    assert motion(ticks(base, 1080, 1080)[0][1]) == (0.0, 0.0, "bumper")
    assert not ticks(base, 1100, 1120)
    assert motion(hand(base, "pilot", GO, 1125 * MS)) == (0.0, 0.0, "bumper")
    assert motion(hand(base, "pilot", BACK, 1250 * MS)) == (-0.1, 0.0, "pilot")
    hand(base, "device", BaseState(), 1300 * MS)
    assert motion(hand(base, "pilot", GO, 1375 * MS))[2] == "pilot"


def test_while_the_devices_guard_holds_nothing_moves_not_even_backwards():
    base = driving()
    hand(base, "device", BaseState(guard=True), 1060 * MS)
    assert motion(ticks(base, 1080, 1080)[0][1]) == (0.0, 0.0, "guard")
    assert motion(hand(base, "pilot", BACK, 1125 * MS)) == (0.0, 0.0, "guard")


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e300, 5.1])
def test_absurd_commands_are_counted_and_stand_still(bad):
    base = Base(REAL, 0)
    assert motion(hand(base, "pilot", Drive(engaged=True, v_mps=bad), FRAME))[:2] == (0.0, 0.0)
    assert motion(hand(base, "pilot", Drive(engaged=True, omega_radps=bad * 4), 2 * FRAME))[:2] == (0.0, 0.0)
    assert base.refused == 2


def test_a_command_from_the_future_is_refused_and_blocks_nothing():
    base = Base(REAL, 0)
    assert hand(base, "pilot", GO, 10**18, FRAME) == ()
    assert motion(hand(base, "pilot", GO, FRAME))[2] == "pilot"


ANY = st.floats(allow_nan=True, allow_infinity=True)
DRIVES = st.builds(Drive, engaged=st.booleans(), v_mps=st.one_of(st.just(0.1), ANY), omega_radps=ANY)
STATES = st.builds(BaseState, bumper=st.booleans(), guard=st.booleans(), v_mps=ANY)
STEPS = st.tuples(
    st.integers(0, 200),
    st.one_of(
        st.tuples(st.sampled_from(["teleop", "grasper", "pilot"]), DRIVES, st.integers(0, 900)),
        st.tuples(st.just("device"), STATES, st.integers(0, 10)),
        st.tuples(st.just("tick"), st.none(), st.just(0)),
        st.tuples(st.just("tick"), st.none(), st.just(0)),
        st.tuples(st.just("gone"), st.sampled_from(["tracker", "viewer"]), st.just(0)),
    ),
)


@settings(max_examples=300, deadline=None)
@given(st.lists(STEPS, max_size=60), st.sampled_from([("pilot",), ("grasper", "pilot")]))
def test_whatever_comes_nothing_moves_without_a_fresh_engaged_command_and_no_frame_is_answered_twice(steps, commanders):
    base = Base(Params(clock="real", commanders=commanders, stop_when_gone=("tracker",)), 0)
    now, answered, engaged, bumper, guard, gone, state_ns = 0, set(), {}, False, False, -1, -1
    for step_ms, (port, message, age_ms) in steps:
        now += step_ms * MS
        capture = now - age_ms * MS if port != "tick" else now
        if port in ("teleop", "grasper", "pilot") and message.engaged:
            engaged.setdefault(capture, set()).add(port)
        if port == "device" and capture > state_ns:
            bumper, guard, state_ns = message.bumper, message.guard, capture
        if port == "gone" and message == "tracker":
            gone = now
        said = base.handle(Event(now, port, message, capture))
        if not said or said[0].port == "state":
            continue
        tells = applied(said)
        if (tells.v_mps, tells.omega_radps) != (0.0, 0.0):
            assert any(tells.commander in ports for c, ports in engaged.items() if now - c <= 300 * MS and c > gone)
            assert not guard
            assert not (bumper and tells.v_mps > 0.0)
            assert abs(tells.v_mps) <= 0.3
        if port in commanders:
            assert said[0].capture_ns not in answered
            answered.add(said[0].capture_ns)
