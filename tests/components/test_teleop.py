"""A person's hands as a commander: whose robot it is, how long a key counts, and which frame a drive answers."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.base.component import Base
from components.base.ports import Params as BaseParams
from components.teleop.component import Teleop
from components.teleop.ports import Params
from docking.task import Task
from runtime.contract import STOP, TICK, Event
from runtime.params import ConfigurationError, build
from schemas.drive_pb2 import BaseState, Drive
from schemas.teleop_pb2 import Hands

MS = 1_000_000
AHEAD = Hands(dead_man=True, forward=1.0)
TAKE, GIVE, FASTER, SLOWER = (Hands(request=request) for request in (1, 2, 3, 4))


def drives(teleop, port, message=None, ms=0, capture_ms=None):
    """The drives that an event causes, each with the frame that it answers in ms."""
    capture_ns = (ms if capture_ms is None else capture_ms) * MS
    return [(o.message, o.capture_ns // MS) for o in teleop.handle(Event(ms * MS, port, message, capture_ns))]


def begun(**params):
    """A teleop that has heard a frame at 1000 ms."""
    teleop = Teleop(Params(**params), 0)
    ((first, _),) = drives(teleop, "base", BaseState(), 1000)
    assert (first.v_mps, first.omega_radps) == (0.0, 0.0)
    return teleop


def test_a_person_has_the_robot_from_the_start_at_rest_unless_the_pilot_begins():
    for begin, has in (("hand", True), ("pilot", False)):
        teleop = Teleop(Params(begin=begin), 0)
        assert drives(teleop, "base", BaseState(), 1000) == [(Drive(engaged=has), 1000)]


def test_before_base_was_heard_nothing_is_said():
    teleop = Teleop(Params(), 0)
    assert drives(teleop, "device", AHEAD, 10) == drives(teleop, TICK, None, 20) == drives(teleop, STOP, None, 30) == []


def test_a_key_drives_at_once_and_is_told_in_every_frame_that_it_is_held():
    teleop = begun()
    (drive, frame) = drives(teleop, "device", AHEAD, 1040)[0]
    assert (drive.v_mps, drive.omega_radps, drive.engaged, drive.dead_man) == (Task().speed_mps, 0.0, True, True)
    assert frame == 1000, "it answers the newest frame, whose age base can tell"
    assert drives(teleop, "device", AHEAD, 1080) == [], "a repeated key says nothing new"
    assert drives(teleop, "base", BaseState(), 1125) == [(drive, 1125)]


def test_a_released_key_stops_the_robot_within_its_time_without_another_frame():
    teleop = begun()
    drives(teleop, "device", AHEAD, 1040)
    stops = [(ms, found[0][0]) for ms in range(1060, 1600, 20) if (found := drives(teleop, TICK, None, ms))]
    assert stops == [(1260, Drive(engaged=True))], "once, 0.2 s after the key, and the person keeps the robot"


def test_the_longest_time_that_a_key_may_count_is_under_300_ms():
    with pytest.raises(ConfigurationError, match="hold_s"):
        build(Params, {"hold_s": 0.26}, "x")


def test_a_key_read_long_ago_moves_nothing():
    teleop = begun()
    assert drives(teleop, "device", AHEAD, 1500, capture_ms=1200) == []


def test_without_the_dead_man_no_stick_moves_anything():
    teleop = begun()
    assert drives(teleop, "device", Hands(forward=1.0, left=1.0), 1040) == []


def test_the_robot_is_given_to_the_pilot_and_taken_back_by_any_motion():
    teleop = begun()
    assert drives(teleop, "device", GIVE, 1010) == [(Drive(), 1000)]
    assert drives(teleop, "device", Hands(dead_man=True), 1020) == [(Drive(dead_man=True), 1000)], "held for base"
    assert drives(teleop, "device", AHEAD, 1030)[0][0].engaged
    drives(teleop, "device", GIVE, 1040)
    assert drives(teleop, "device", TAKE, 1050) == [(Drive(engaged=True), 1000)]


def test_the_arcs_at_the_first_speed_are_the_tasks_actions():
    teleop = begun()
    for left, (v, omega) in zip((1.0, -1.0), Task().actions, strict=True):
        drive, _ = drives(teleop, "device", Hands(dead_man=True, forward=1.0, left=left), 1040)[0]
        assert (drive.v_mps, drive.omega_radps) == (v, omega)


def test_faster_and_slower_end_at_their_limits_and_do_not_let_go():
    teleop = begun()
    drives(teleop, "device", AHEAD, 1040)
    for _ in range(20):
        drives(teleop, "device", FASTER, 1050)
    ((fast, _),) = drives(teleop, "base", BaseState(), 1060)
    assert fast.v_mps == pytest.approx(0.1 * 1.25**5)
    for _ in range(20):
        drives(teleop, "device", SLOWER, 1070)
    ((slow, _),) = drives(teleop, "base", BaseState(), 1080)
    assert slow.v_mps == pytest.approx(0.1 / 1.25**5)


def test_the_end_of_the_run_is_a_stop():
    teleop = begun()
    drives(teleop, "device", AHEAD, 1040)
    assert drives(teleop, STOP, None, 1060) == [(Drive(engaged=True), 1000)]


def test_with_another_hosts_clock_far_ahead_a_drive_still_answers_the_robots_frame():
    teleop = begun()
    assert drives(teleop, "base", BaseState(), 1100, capture_ms=99_000) == [(Drive(engaged=True), 99_000)]
    assert drives(teleop, "device", AHEAD, 1110)[0][1] == 99_000
    assert drives(teleop, TICK, None, 1320) == [(Drive(engaged=True), 99_000)], "the key's age is of this clock"


def test_a_cut_link_stops_the_robot_that_is_driven_from_afar_within_300_ms():
    """Teleop answers frames up to 1000 ms; then nothing comes any more, and the pilot would like to drive."""
    base, teleop = Base(BaseParams(clock="real", commanders=("pilot",)), 0), Teleop(Params(), 0)
    for ms in range(0, 1001, 125):
        teleop.handle(Event(ms * MS, "device", AHEAD, ms * MS))
        for said in teleop.handle(Event(ms * MS, "base", BaseState(), ms * MS)):
            base.handle(Event(ms * MS, "teleop", said.message, said.capture_ns))
    stopped = []
    for ms in range(1020, 3000, 20):
        for said in base.handle(Event(ms * MS, TICK, None, ms * MS)):
            stopped += [ms] if said.port == "applied" else []
        if ms % 125 < 20:
            for said in base.handle(Event(ms * MS, "pilot", Drive(engaged=True, v_mps=0.1), ms * MS)):
                assert said.port != "applied" or said.message.commander in ("teleop", "stale")
                assert said.port != "applied" or ms <= 1300 or said.message.v_mps == 0.0
    assert stopped[0] <= 1320


def test_a_robot_that_begins_in_a_persons_hand_rests_until_the_person_was_heard():
    base = Base(BaseParams(clock="real", commanders=("pilot",), begins_with=("teleop",)), 0)
    pilot = Drive(engaged=True, v_mps=0.1)
    (_, first) = base.handle(Event(125 * MS, "pilot", pilot, 125 * MS))
    assert (first.message.v_mps, first.message.commander) == (0.0, "none")
    base.handle(Event(130 * MS, "teleop", Drive(), 125 * MS))
    (_, then) = base.handle(Event(250 * MS, "pilot", pilot, 250 * MS))
    assert then.message.commander == "pilot"


def test_a_beginning_with_nobody_is_refused_by_name():
    with pytest.raises(ConfigurationError, match="begins_with must be some of teleop, grasper, pilot"):
        build(BaseParams, {"begins_with": ["telop"]}, "x")


ANY = st.floats(allow_nan=False, allow_infinity=False)
HANDS = st.builds(
    Hands, dead_man=st.booleans(), forward=ANY, left=ANY, request=st.integers(0, 2**31 - 1)
)  # unknown numbers are kept by protobuf
STEPS = st.lists(st.tuples(st.integers(0, 300), st.sampled_from(["device", "base", TICK]), HANDS), max_size=40)


@given(STEPS)
def test_whatever_the_hands_say_motion_needs_a_dead_man_younger_than_its_time_and_is_bounded(steps):
    teleop, ms, held_ms = Teleop(Params(), 0), 0, -(10**9)
    for step, port, hands in steps:
        ms += step
        if port == "device" and hands.request not in (3, 4):
            held_ms = ms if hands.dead_man else -(10**9)
        for drive, _ in drives(teleop, port, hands if port == "device" else BaseState(), ms):
            assert math.isfinite(drive.v_mps)
            assert abs(drive.v_mps) <= 0.1 * 1.25**5 + 1e-9
            if drive.v_mps or drive.omega_radps:
                assert ms - held_ms <= 200
