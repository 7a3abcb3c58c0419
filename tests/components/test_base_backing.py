"""Backing up safely: what stops a robot that drives backwards, by name, on the simulated body with a real wall."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.base.backing import Backing, Reading
from components.base.component import Base
from components.base.ports import Params
from components.simulator.base import Base as Body
from components.simulator.base import Pose, Twist
from components.simulator.params import Params as World
from docking import plant
from runtime.contract import Event
from schemas.drive_pb2 import BaseState, Drive
from tests.components.test_base import MS, applied, hand, motion

BACK = Drive(engaged=True, v_mps=-0.2)
AHEAD = Drive(engaged=True, v_mps=0.2)
FREE = BaseState()


def base(**changes):
    return Base(Params(commanders=("pilot",), **{"clock": "real", **changes}), 0)


def told(robot, state, command=BACK, ms=1000):
    """(v, omega, commander) after a state and a command in one frame."""
    hand(robot, "device", state, ms * MS)
    return motion(hand(robot, "pilot", command, ms * MS))


def at(x=0.0, y=0.0, heading=0.0, **more):
    return BaseState(odometry_x_m=x, odometry_y_m=y, odometry_heading_rad=heading, **more)


@pytest.mark.parametrize(
    ("state", "reason"),
    [
        (BaseState(rear_bumper=True), "rear-bumper"),
        (BaseState(rear_range_m=0.35), "rear"),
        (BaseState(rear_range_m=0.0), "rear"),
        (BaseState(rear_range_m=-1.0), "rear"),
    ],
)
def test_bumper_and_range_behind_stop_the_way_back_by_name_and_leave_the_way_ahead_free(state, reason):
    assert told(base(), state) == (0.0, 0.0, reason)
    assert told(base(), state, AHEAD)[2] == "pilot"


def test_with_free_way_behind_or_without_a_sensor_the_robot_backs():
    assert told(base(), BaseState(rear_range_m=0.36))[2] == "pilot"
    assert told(base(), FREE)[2] == "pilot"


def test_between_two_frames_the_stop_comes_on_the_next_tick():
    robot = base()
    assert told(robot, BaseState(rear_range_m=1.0))[0] < 0.0
    hand(robot, "device", BaseState(rear_range_m=0.3), 1060 * MS)
    assert motion(robot.handle(Event(1080 * MS, "tick", None, 1080 * MS))) == (0.0, 0.0, "rear")
    assert robot.handle(Event(1100 * MS, "tick", None, 1100 * MS)) == ()


def backed(robot, way_m, first_ms, step_m=0.025):
    """Drive back along x by odometry; returns the frame's answers."""
    answers = []
    for k in range(round(abs(way_m) / step_m)):
        ms = first_ms + 125 * k
        x = robot._state.odometry_x_m + math.copysign(step_m, way_m)
        answers.append(told(robot, at(x), BACK if way_m < 0 else AHEAD, ms))
    return answers


def test_the_longest_way_back_ends_by_name_and_begins_anew_after_a_way_ahead():
    robot = base(max_reverse_m=1.0, fence_m=100.0)
    told(robot, at())
    answers = backed(robot, -1.2, 2000)
    first = next(k for k, answer in enumerate(answers) if answer[2] == "reverse")
    assert (first + 1) * 0.025 == pytest.approx(1.0)
    assert all(answer == (0.0, 0.0, "reverse") for answer in answers[first:])
    assert backed(robot, 0.05, 20_000)[-1][2] == "pilot"
    assert told(robot, at(robot._state.odometry_x_m), BACK, 21_000)[2] == "reverse", "5 cm ahead are not enough"
    backed(robot, 0.1, 22_000)
    assert told(robot, at(robot._state.odometry_x_m), BACK, 23_000)[2] == "pilot"


def test_beyond_the_fence_only_the_way_out_is_forbidden():
    robot = base(fence_m=1.0)
    told(robot, at())
    assert told(robot, at(-0.05), BACK, 1125)[2] == "pilot"
    answers = backed(robot, -1.2, 2000)
    assert answers[-1] == (0.0, 0.0, "fence")
    x = robot._state.odometry_x_m
    assert told(robot, at(x, heading=math.pi), BACK, 30_000)[2] == "pilot", "turned round, backwards leads home"
    assert told(robot, at(x), AHEAD, 30_125)[2] == "pilot"


def test_odometry_that_is_set_to_zero_takes_fence_and_distance_along():
    backing = Backing(Params(fence_m=1.0, max_reverse_m=2.0))
    for k in range(37):
        backing.see(Reading(k * 125 * MS, -0.025 * k, 0.0, 0.0, None, rear_bumper=False))
    assert backing.backed_m == pytest.approx(0.9)
    for k in range(37, 43):
        backing.see(Reading(k * 125 * MS, 5.0 - 0.025 * (k - 37), 0.0, 0.0, None, rear_bumper=False))
    assert backing.backed_m == pytest.approx(0.9 + 5 * 0.025)
    assert backing.hindrance() == "fence"


@given(st.floats(-3, 3), st.floats(-0.3, -0.05), st.floats(-0.5, 0.5))
def test_the_way_back_is_the_length_of_the_arc_whatever_its_direction(heading, v, omega):
    """Against the closed form: speed times time."""
    backing, pose = Backing(Params()), (1.0, -2.0, heading)
    for k in range(81):
        backing.see(Reading(k * 125 * MS, *pose, None, rear_bumper=False))
        pose = plant.advance(*pose, v, omega, 0.125)
    assert backing.backed_m == pytest.approx(-v * 10.0, rel=0.002)


@pytest.mark.parametrize(
    ("need", "command", "moves"),
    [
        ("never", BACK, True),
        ("reverse", BACK, False),
        ("reverse", AHEAD, True),
        ("always", AHEAD, False),
        ("always", Drive(engaged=True, omega_radps=0.2), False),
    ],
)
def test_without_a_held_key_the_pilot_does_not_move_what_needs_one(need, command, moves):
    v, omega, commander = told(base(dead_man=need), FREE, command)
    assert told(base(dead_man=need), FREE, command, ms=100)[2] == commander, "in the first moment too"
    assert ((v, omega) != (0.0, 0.0)) == moves
    assert commander == ("pilot" if moves else "dead-man")


def test_a_held_key_lets_the_pilot_drive_and_its_release_stops_it_on_the_next_tick():
    robot = base(dead_man="always")
    hand(robot, "teleop", Drive(dead_man=True), 1000 * MS)
    assert told(robot, FREE, AHEAD, 1125)[2] == "pilot"
    hand(robot, "teleop", Drive(dead_man=False), 1125 * MS, 1140 * MS)
    assert motion(robot.handle(Event(1160 * MS, "tick", None, 1160 * MS))) == (0.0, 0.0, "dead-man")


def test_a_key_that_is_told_of_no_more_counts_as_released_after_the_longest_age():
    robot = base(dead_man="always")
    hand(robot, "teleop", Drive(dead_man=True), 1000 * MS)
    assert told(robot, FREE, AHEAD, 1300)[2] == "pilot"
    assert told(robot, FREE, AHEAD, 1425) == (0.0, 0.0, "dead-man")


def reversing_towards_a_wall(world, params, command, start=(-0.5, 0.0, 0.0)):
    """Base and the simulated body in a loop of 8 frames a second. Returns (body, reasons in order)."""
    body, robot, odometry, reasons = Body(world, Pose(*start)), Base(params, 0), Pose(0.0, 0.0, 0.0), []
    for k in range(400):
        now_ns = k * 125 * MS
        state = at(*odometry.triple, rear_range_m=body.rear_range_m, rear_bumper=body.rear_bumper)
        hand(robot, "device", state, now_ns)
        message = applied(hand(robot, "pilot", command, now_ns))
        reasons += [message.commander] if [message.commander] != reasons[-1:] else []
        body.command(Twist(message.v_mps, message.omega_radps), now_ns)
        for step in range(8):
            body.step(now_ns + step * 15_625_000, 1 / 64)
            odometry.move(body.v_mps, body.omega_radps, 1 / 64)
    return body, reasons


@pytest.mark.parametrize("v_mps", [-0.1, -0.2, -0.3, -5.0])
def test_a_robot_that_reverses_towards_a_wall_stops_before_it_and_says_why(v_mps):
    world = World(wall_behind_m=2.0, rear_reach_m=4.0)
    body, reasons = reversing_towards_a_wall(world, Params(commanders=("pilot",)), Drive(engaged=True, v_mps=v_mps))
    assert reasons == ["pilot", "rear"]
    assert body.v_mps == 0.0
    assert not body.rear_bumper
    assert 0.1 < body.rear_range_m <= 0.35


def test_without_a_range_sensor_the_bumper_ends_it_at_the_wall():
    body, reasons = reversing_towards_a_wall(World(wall_behind_m=2.0), Params(commanders=("pilot",)), BACK)
    assert reasons == ["pilot", "rear-bumper"]
    assert body.v_mps == 0.0
    assert body.pose.x_m == pytest.approx(-2.0 + 0.18, abs=0.01)


@pytest.mark.parametrize(("limits", "reason"), [({"max_reverse_m": 0.5}, "reverse"), ({"fence_m": 0.5}, "fence")])
def test_without_any_sensor_behind_distance_and_fence_hold_alone(limits, reason):
    body, reasons = reversing_towards_a_wall(World(), Params(commanders=("pilot",), **limits), BACK)
    assert reasons == ["pilot", reason]
    assert 0.5 <= -0.5 - body.pose.x_m <= 0.65, "half a metre, and the way that it takes to stop"


STATES = st.builds(
    BaseState,
    odometry_x_m=st.floats(-9, 9),
    odometry_heading_rad=st.floats(-4, 4),
    rear_bumper=st.booleans(),
    rear_range_m=st.one_of(st.none(), st.floats(-1.0, 3.0)),
)


@given(st.lists(st.tuples(STATES, st.floats(-0.5, 0.5), st.booleans()), max_size=30))
def test_whatever_is_read_no_way_back_is_driven_against_bumper_range_or_open_hand(steps):
    robot = base(dead_man="reverse")
    for k, (state, v, held) in enumerate(steps):
        ms = 1000 + 125 * k
        hand(robot, "teleop", Drive(dead_man=held), ms * MS)
        said = told(robot, state, Drive(engaged=True, v_mps=v), ms)
        if said[0] < 0.0:
            assert held
            assert not state.rear_bumper
            assert not state.HasField("rear_range_m") or state.rear_range_m > 0.35
