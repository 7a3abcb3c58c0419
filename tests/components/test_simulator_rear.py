"""The wall behind the simulated robot: it stops the body, presses the bumper, and the range sensor sees it coming."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.simulator.base import Base, Pose, Twist
from components.simulator.params import Params
from tests.components.test_simulator_base import STEP_S, run

WALL = Params(wall_behind_m=2.0, rear_reach_m=3.0)


def test_without_a_sensor_nothing_is_told_and_without_a_wall_the_way_is_free():
    assert Base(Params(), Pose(-1.0, 0.0, 0.0)).rear_range_m is None
    assert Base(Params(rear_reach_m=3.0), Pose(-1.0, 0.0, 0.0)).rear_range_m == 3.0


def test_the_wall_stops_the_robot_and_the_rear_bumper_alone_tells():
    base = Base(WALL, Pose(-1.5, 0.1, 0.0))
    run(base, 5.0, Twist(-0.2, 0.0))
    assert base.pose.x_m == pytest.approx(-2.0 + 0.18, abs=0.2 * STEP_S)
    assert base.pose.x_m >= -2.0 + 0.18
    assert base.rear_bumper
    assert not base.bumper
    assert base.rear_range_m == pytest.approx(0.0, abs=0.2 * STEP_S)
    run(base, 1.0, Twist(0.1, 0.0), begin_ns=5_000_000_000)
    assert not base.rear_bumper


def test_a_robot_that_faces_the_wall_presses_its_front_bumper():
    base = Base(WALL, Pose(-1.5, 0.0, math.pi))
    run(base, 5.0, Twist(0.2, 0.0))
    assert base.bumper
    assert not base.rear_bumper


@given(st.floats(-1.8, -0.3), st.floats(-1.2, 1.2))
def test_the_range_is_the_way_that_the_robot_can_back_until_it_points_at_the_wall(x, heading):
    """Against the definition: the rear point of the circle, moved back by the range, lies on the wall."""
    range_m = Base(WALL, Pose(x, 0.0, heading)).rear_range_m
    on_wall = x - (0.18 + range_m) * math.cos(heading)
    if 0.0 < range_m < 3.0:
        assert on_wall == pytest.approx(-2.0)
    else:
        assert (on_wall > -2.0) == (range_m == 3.0)


@given(st.floats(-1.8, -0.5), st.floats(-3.2, 3.2), st.floats(-0.5, 0.5), st.floats(-2.0, 2.0))
def test_no_drive_takes_it_through_the_wall(x, heading, v, omega):
    base = Base(WALL, Pose(x, 0.0, heading))
    run(base, 2.0, Twist(v, omega))
    assert base.pose.x_m >= -2.0 + 0.18 - 1e-9
