"""The plant against its definition: the differential equations of a unicycle that sees a point."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from docking import plant
from docking.angles import DEG, wrap

speeds = st.floats(-0.2, 0.2)
rates = st.floats(-0.5, 0.5)
angles = st.floats(-1.2, 1.2)
distances = st.floats(0.3, 2.5)


@given(angles, angles, distances)
def test_pose_and_observe_are_inverse(beta, alpha, d):
    assert plant.observe(*plant.pose(beta, alpha, d)) == pytest.approx((beta, alpha, d), abs=1e-9)


@given(angles, angles, distances, speeds, rates)
def test_rates_are_those_of_geometry_not_those_printed(beta, alpha, d, v, omega):
    """alpha' = +(v/d) sin(alpha) - omega: driving past a thing makes its bearing grow."""
    dt = 1e-5
    after = plant.observe(*plant.advance(*plant.pose(beta, alpha, d), v, omega, dt))
    expected = (v / d * math.sin(alpha), v / d * math.sin(alpha) - omega, -v * math.cos(alpha))
    measured = [wrap(after[0] - beta) / dt, wrap(after[1] - alpha) / dt, (after[2] - d) / dt]
    assert measured == pytest.approx(expected, abs=2e-4)


@given(angles, angles, distances, speeds, rates)
def test_one_arc_equals_many_small_ones(beta, alpha, d, v, omega):
    start = plant.pose(beta, alpha, d)
    pose = start
    for _ in range(50):
        pose = plant.advance(*pose, v, omega, 0.01)
    assert pose == pytest.approx(plant.advance(*start, v, omega, 0.5), abs=1e-9)


@given(angles, angles, distances, speeds, rates)
def test_mirroring_state_and_action_mirrors_the_outcome(beta, alpha, d, v, omega):
    one = plant.observe(*plant.advance(*plant.pose(beta, alpha, d), v, omega, 0.5))
    other = plant.observe(*plant.advance(*plant.pose(-beta, -alpha, d), v, -omega, 0.5))
    assert other == pytest.approx((-one[0], -one[1], one[2]), abs=1e-9)


@given(angles, angles, distances, rates)
def test_reversing_undoes_driving(beta, alpha, d, omega):
    start = plant.pose(beta, alpha, d)
    there = plant.advance(*start, 0.1, omega, 0.7)
    assert plant.advance(*there, -0.1, -omega, 0.7) == pytest.approx(start, abs=1e-9)


def test_turning_radius_is_v_over_omega():
    x, y, heading = plant.advance(0.0, 0.0, 0.0, 0.1, 10 * DEG, 18.0)
    assert (x, heading) == pytest.approx((0.0, math.pi), abs=1e-9)
    assert y == pytest.approx(2 * 0.1 / (10 * DEG))


def test_the_printed_plant_differs_in_the_sign_of_the_line_of_sight_rate():
    beta_rate, alpha_rate, d_rate = plant.printed_rates(0.3, 1.5, 0.1, 0.1)
    assert beta_rate == pytest.approx(-0.1 / 1.5 * math.sin(0.3))
    assert alpha_rate == pytest.approx(beta_rate - 0.1)
    assert d_rate == pytest.approx(-0.1 * math.cos(0.3))
