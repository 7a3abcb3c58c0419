"""The base: who commands, within which limits, and one answer for each frame."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.base.component import Base
from components.base.motion import Motion, limited
from components.base.ports import Params
from runtime.contract import STOP, Event
from schemas.drive_pb2 import GRIPPER_CLOSE, GRIPPER_KEEP, GRIPPER_LOWER, Applied, BaseCommand, BaseState, Drive

MS = 1_000_000
FRAME = 125 * MS
GO = Drive(engaged=True, v_mps=0.1, omega_radps=0.17)
IDLE = Drive(engaged=False)
SLOW = Drive(engaged=True, v_mps=0.02, omega_radps=0.0, gripper=GRIPPER_LOWER)


def hand(base, port, message, capture_ns, time_ns=None):
    return base.handle(Event(capture_ns if time_ns is None else time_ns, port, message, capture_ns))


def applied(said):
    """The single `applied` of an answer, checked against its `actuate`."""
    actuate, tells = said
    assert (actuate.port, tells.port) == ("actuate", "applied")
    assert actuate.capture_ns == tells.capture_ns
    command, message = actuate.message, tells.message
    assert isinstance(command, BaseCommand)
    assert isinstance(message, Applied)
    assert (command.v_mps, command.omega_radps, command.gripper) == (
        message.v_mps,
        message.omega_radps,
        message.gripper,
    )
    return message


def motion(said):
    message = applied(said)
    return message.v_mps, message.omega_radps, message.commander


def test_the_pilots_command_passes_when_the_grasper_does_not_want_the_robot():
    base = Base(Params(), 0)
    assert hand(base, "pilot", GO, FRAME) == ()
    assert motion(hand(base, "grasper", IDLE, FRAME)) == (0.1, 0.17, "pilot")


def test_the_order_of_the_answers_does_not_matter():
    base = Base(Params(), 0)
    assert hand(base, "grasper", IDLE, FRAME) == ()
    assert motion(hand(base, "pilot", GO, FRAME)) == (0.1, 0.17, "pilot")


def test_an_engaged_grasper_wins_at_once_and_the_pilot_is_not_answered_again():
    base = Base(Params(), 0)
    message = applied(hand(base, "grasper", SLOW, FRAME))
    assert (message.v_mps, message.commander, message.gripper) == (0.02, "grasper", GRIPPER_LOWER)
    assert hand(base, "pilot", GO, FRAME) == ()
    assert hand(base, "grasper", SLOW, FRAME) == ()


def test_with_nobody_engaged_the_robot_stands_still_and_the_gripper_goes_on():
    base = Base(Params(), 0)
    hand(base, "pilot", Drive(engaged=False, v_mps=0.1, gripper=GRIPPER_CLOSE), FRAME)
    message = applied(hand(base, "grasper", IDLE, FRAME))
    assert (message.v_mps, message.commander, message.gripper) == (0.0, "none", GRIPPER_KEEP)


def test_alone_the_pilot_is_answered_at_once():
    base = Base(Params(commanders=("pilot",)), 0)
    assert motion(hand(base, "pilot", GO, FRAME)) == (0.1, 0.17, "pilot")


def test_in_lockstep_a_frame_waits_for_ever_for_its_second_answer():
    base = Base(Params(), 0)
    hand(base, "pilot", GO, FRAME)
    assert base.handle(Event(FRAME + 10**9, "tick", None, FRAME + 10**9)) == ()
    assert applied(hand(base, "grasper", IDLE, FRAME, FRAME + 2 * 10**8)).commander == "pilot"


def test_in_real_time_a_frame_is_decided_on_the_tick_after_20_ms_with_what_is_there():
    base = Base(Params(clock="real"), 0)
    hand(base, "pilot", GO, FRAME, FRAME + 5 * MS)
    assert base.handle(Event(FRAME + 20 * MS, "tick", None, FRAME + 20 * MS)) == ()
    assert motion(base.handle(Event(FRAME + 40 * MS, "tick", None, FRAME + 40 * MS))) == (0.1, 0.17, "pilot")
    assert hand(base, "grasper", SLOW, FRAME, FRAME + 50 * MS) == ()


def test_a_newer_frame_is_answered_and_no_older_one_after_it():
    base = Base(Params(clock="real"), 0)
    hand(base, "pilot", GO, FRAME)
    hand(base, "pilot", GO, 2 * FRAME)
    said = hand(base, "grasper", IDLE, 2 * FRAME)
    assert said[0].capture_ns == 2 * FRAME
    assert hand(base, "grasper", IDLE, FRAME, 2 * FRAME) == ()


def test_a_person_comes_before_everyone_and_at_once():
    base = Base(Params(clock="real"), 0)
    said = hand(base, "teleop", SLOW, 5 * MS)
    assert motion(said) == (0.02, 0.0, "teleop")
    assert motion(hand(base, "pilot", GO, FRAME)) == (0.02, 0.0, "teleop")


def test_a_person_who_lets_go_leaves_the_robot_to_the_pilot():
    base = Base(Params(clock="real"), 0)
    hand(base, "teleop", SLOW, 5 * MS)
    hand(base, "teleop", IDLE, 10 * MS)
    hand(base, "pilot", GO, FRAME)
    assert motion(hand(base, "grasper", IDLE, FRAME)) == (0.1, 0.17, "pilot")


def test_letting_go_stops_the_robot_without_waiting_for_a_frame():
    base = Base(Params(clock="real"), 0)
    hand(base, "teleop", SLOW, 5 * MS)
    assert motion(hand(base, "teleop", IDLE, 10 * MS)) == (0.0, 0.0, "none")
    assert hand(base, "teleop", IDLE, 15 * MS) == ()


def test_in_lockstep_a_persons_command_waits_for_the_next_frame():
    base = Base(Params(), 0)
    assert hand(base, "teleop", SLOW, 5 * MS) == ()
    assert motion(hand(base, "pilot", GO, FRAME)) == (0.02, 0.0, "teleop")


def test_the_learners_actions_from_rest_and_reversed_are_not_cut():
    before, params = Motion(), Params()
    for omega in (0.1745, -0.1745, 0.1745):
        before = limited(Motion(0.1, omega), before, 0.125, params)
        assert before[:2] == (0.1, omega)


@pytest.mark.parametrize(("wish", "expected"), [(1.0, 0.3), (-1.0, -0.3), (0.1, 0.1)])
def test_speed_is_limited(wish, expected):
    assert limited(Motion(wish, 0.0), Motion(wish, 0.0), 0.125, Params()).v_mps == expected


def test_speed_grows_by_the_limit_of_acceleration_and_falls_at_once():
    params = Params(max_acceleration_mps2=0.4)
    first = limited(Motion(0.2, 0.0), Motion(), 0.125, params)
    assert first.v_mps == pytest.approx(0.05)
    assert limited(Motion(0.2, 0.0), first, 0.125, params).v_mps == pytest.approx(0.1)
    assert limited(Motion(-0.2, 0.0), Motion(0.2, 0.0), 0.125, params).v_mps == pytest.approx(-0.05)
    assert limited(Motion(0.0, 0.0), Motion(0.2, 0.0), 0.125, params).v_mps == 0.0


@given(st.tuples(*[st.floats(-4, 4)] * 4), st.floats(-1, 3))
def test_a_limited_motion_never_exceeds_the_wish_the_limits_or_its_mirror(numbers, since_s):
    v, omega, v_before, omega_before = numbers
    params, before = Params(), Motion(v_before, omega_before)
    found = limited(Motion(v, omega), before, since_s, params)
    assert abs(found.v_mps) <= min(abs(v), params.max_speed_mps)
    assert abs(found.omega_radps) <= min(abs(omega), params.max_turn_rate_radps)
    mirror = limited(Motion(v, -omega), Motion(v_before, -omega_before), since_s, params)
    assert (mirror.v_mps, mirror.omega_radps) == (found.v_mps, -found.omega_radps)


def test_the_state_is_passed_on_once_and_a_number_that_is_none_keeps_the_last():
    base = Base(Params(), 0)
    good = BaseState(odometry_x_m=1.0, v_mps=0.1, lift_up=True)
    (output,) = hand(base, "device", good, FRAME)
    assert (output.port, output.message) == ("state", good)
    assert hand(base, "device", good, FRAME) == ()
    (output,) = hand(base, "device", BaseState(odometry_x_m=math.nan, bumper=True), 2 * FRAME)
    assert (output.message.odometry_x_m, output.message.v_mps, output.message.bumper) == (1.0, 0.1, True)
    assert base.refused == 1


def test_the_last_event_is_a_stop():
    base = Base(Params(), 0)
    hand(base, "pilot", GO, FRAME)
    hand(base, "grasper", IDLE, FRAME)
    assert motion(base.handle(Event(2 * FRAME, STOP, None, 2 * FRAME))) == (0.0, 0.0, "stop")


ANY = st.floats(allow_nan=True, allow_infinity=True)
DRIVES = st.builds(
    Drive, engaged=st.booleans(), v_mps=st.one_of(st.floats(-1, 1), ANY), omega_radps=ANY, gripper=st.integers(0, 99)
)
ANSWER = st.tuples(st.permutations(["grasper", "pilot"]), DRIVES, DRIVES, st.booleans(), st.booleans())


@settings(max_examples=200, deadline=None)
@given(st.lists(ANSWER, max_size=30))
def test_in_lockstep_every_frame_is_answered_exactly_once(frames):
    base = Base(Params(), 0)
    for k, (order, first, second, bumper, repeat) in enumerate(frames):
        now = k * FRAME
        base.handle(Event(now, "tick", None, now))
        said = list(hand(base, "device", BaseState(bumper=bumper), now))
        assert [o.port for o in said] == ["state"]
        said = [*hand(base, order[0], first, now), *hand(base, order[1], second, now)]
        if repeat:
            said += hand(base, order[0], first, now)
        message = applied(said)
        assert said[0].capture_ns == now
        assert abs(message.v_mps) <= 0.3
        assert not (bumper and message.v_mps > 0.0)
        winner = {"grasper": first, "pilot": second} if order[0] == "grasper" else {"grasper": second, "pilot": first}
        if not any(d.engaged for d in winner.values()):
            assert (message.v_mps, message.omega_radps, message.commander) == (0.0, 0.0, "none")
        elif message.commander != "bumper":
            assert message.commander == ("grasper" if winner["grasper"].engaged else "pilot")
