"""Gaze, servo, drift and base motion of the tracker, against the pinhole, the plant and closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.tracker.base_motion import BaseMotion, Limits, ramp
from components.tracker.drift import Drift, smoother
from components.tracker.gaze import direction, slope_at_centre
from components.tracker.servo import Servo
from docking import plant
from docking.pinhole import Mount

FOCAL = 364.0
SMOOTHER = smoother(0.6)
EDGE = np.array([-0.05, 0.0, -0.07])
BETA, ALPHA, D = st.floats(-1.1, 1.1), st.floats(-1.3, 1.3), st.floats(0.3, 2.5)
OFF = st.floats(-0.12, 0.12)


def camera_of(beta, alpha, d, off_pan, off_tilt):
    """(camera, pan, tilt) that looks beside the object by these angles."""
    pan, tilt = alpha + off_pan, math.atan2(0.45, d) + off_tilt
    return Mount().camera(plant.pose(beta, alpha, d), pan, tilt, FOCAL), pan, tilt


@given(BETA, ALPHA, D, OFF, OFF)
def test_the_direction_of_a_pixel_is_the_bearing_and_depression_of_the_object(beta, alpha, d, off_pan, off_tilt):
    camera, pan, tilt = camera_of(beta, alpha, d, off_pan, off_tilt)
    u, v = camera.project(np.zeros((1, 3)))[0]
    bearing, depression = direction(u, v, pan, tilt, FOCAL)
    assert bearing == pytest.approx(alpha, abs=1e-9)
    assert depression == pytest.approx(math.atan2(0.45, d), abs=1e-9)


@given(BETA, ALPHA, D, OFF, OFF)
def test_the_slope_at_the_centre_is_tan_beta_sin_tilt_wherever_the_camera_looks(beta, alpha, d, off_pan, off_tilt):
    camera, pan, tilt = camera_of(beta, alpha, d, off_pan, off_tilt)
    (u, v), (edge_u, edge_v) = camera.project(np.array([np.zeros(3), EDGE]))
    slope = camera.slope(EDGE, np.array([0.0, 1.0, 0.0]))
    bearing, depression = direction(u, v, pan, tilt, FOCAL)
    at_centre = slope_at_centre(slope, u, edge_v + slope * (u - edge_u), tilt, FOCAL, bearing - pan, depression)
    assert math.atan2(at_centre, math.sin(depression)) == pytest.approx(beta, abs=1e-6)


@given(st.floats(0.01, 1.0), st.floats(0.0, 1.0), st.lists(st.floats(0.0, 1.0), min_size=5, max_size=60))
def test_the_head_never_overshoots_whatever_part_of_a_correction_it_manages(p, share, managed):
    servo, gain_d, error = Servo(), share * (1.0 - p), 1.0
    for part in managed:
        correction = servo.correction_rad(error, p, gain_d)
        error -= part * max(correction, 0.0)
        assert -1e-12 <= error <= 1.0


def test_the_derivative_does_not_kick_when_the_object_appears():
    servo = Servo()
    assert servo.correction_rad(0.2, 0.8, 0.2) == pytest.approx(0.16)
    servo.forget()
    assert servo.correction_rad(-0.2, 0.8, 0.2) == pytest.approx(-0.16)


@given(st.floats(-2, 2), st.floats(-2, 2), st.floats(0.1, 5), st.floats(0.0, 1.0))
def test_a_ramp_is_the_limit_of_small_steps(rate, target, limit, dt_s):
    slow, way, n = rate, 0.0, 2000
    for _ in range(n):
        before = slow
        slow += min(max(target - slow, -limit * dt_s / n), limit * dt_s / n)
        way += 0.5 * (before + slow) * dt_s / n
    reached, integral = ramp(rate, target, limit, dt_s)
    assert reached == pytest.approx(slow, abs=1e-9)
    assert integral == pytest.approx(way, abs=2e-3 * dt_s * (abs(target - rate) + 1e-9) + 1e-12)


def test_a_command_acts_from_its_time_on_and_not_before():
    motion = BaseMotion()
    motion.advance(0, Limits(0.5, 1.0))
    motion.command(100_000_000, 0.1, 0.0)
    assert not motion.at_rest
    assert motion.ahead(0.1, Limits(0.5, 1.0)) == (0.0, 0.0)
    # 0.2 s of ramp to 0.1 m/s, then 0.2 s at it
    assert motion.ahead(0.5, Limits(0.5, 1.0))[0] == pytest.approx(0.01 + 0.02)
    motion.advance(500_000_000, Limits(0.5, 1.0))
    assert (motion.v_mps, motion.way_m) == (pytest.approx(0.1), pytest.approx(0.03))


def test_commands_that_never_become_due_are_bounded():
    motion = BaseMotion()
    for i in range(1000):
        motion.command(10**15 + i, 0.1, 0.0)
    assert len(motion.pending) < 10


@pytest.mark.parametrize("v", [0.1, -0.1, 0.3])
def test_the_drift_is_sine_alpha_over_distance_whatever_the_speed_and_the_turns(v):
    drift, pose = Drift(), plant.pose(0.3, 0.5, 1.5)
    for _ in range(20):
        _, alpha, d = plant.observe(*pose)
        turned = pose[2] - plant.pose(0.3, 0.5, 1.5)[2]
        drift.update(alpha + turned, v * 0.125, SMOOTHER)
        pose = plant.advance(*pose, v, v / d * math.sin(alpha), 0.125)
    assert alpha == pytest.approx(0.5, abs=0.01)
    assert drift.rad_per_m == pytest.approx(math.sin(alpha) / d, rel=0.15)


def test_the_drift_stays_when_the_robot_stands_and_when_it_reverses():
    drift = Drift()
    for i in range(50):
        drift.update(0.5 * 0.0125 * i, 0.0125, SMOOTHER)
    before = drift.rad_per_m
    for _ in range(20):
        drift.update(0.5 * 0.0125 * 49, 0.0, SMOOTHER)
    assert drift.rad_per_m == before == pytest.approx(0.5, rel=1e-6)
    drift.update(0.5 * 0.0125 * 48, -0.0125, SMOOTHER)
    assert drift.rad_per_m == pytest.approx(0.5, rel=1e-6)


def test_a_jump_of_the_object_is_no_drift():
    drift = Drift()
    for i in range(20):
        drift.update(0.5 * 0.0125 * i, 0.0125, SMOOTHER)
    drift.update(1.0, 0.0125, SMOOTHER)
    assert drift.rad_per_m == 0.0
