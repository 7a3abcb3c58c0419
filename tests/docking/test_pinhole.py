"""The projection against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from docking import plant
from docking.angles import DEG
from docking.pinhole import Camera, Mount

FOCAL_PX = 364.0
ORIGIN = np.zeros(3)
ALONG_EDGE = np.array((0.0, 1.0, 0.0))

betas = st.floats(-75 * DEG, 75 * DEG)
alphas = st.floats(-80 * DEG, 80 * DEG)
distances_m = st.floats(0.2, 2.5)


def looking_at_object(beta_rad: float, alpha_rad: float, d_axle_m: float, up_m: float = 0.45) -> Camera:
    pose = plant.pose(beta_rad, alpha_rad, d_axle_m)
    return Mount(up_m=up_m).camera(pose, alpha_rad, math.atan2(up_m, d_axle_m), FOCAL_PX)


@given(betas, alphas, distances_m)
def test_pan_of_the_bearing_and_tilt_of_the_distance_bring_the_object_to_the_centre(beta, alpha, d):
    assert looking_at_object(beta, alpha, d).project(ORIGIN[None])[0] == pytest.approx((0, 0), abs=1e-9)


@given(betas, alphas, distances_m)
def test_slope_at_the_centre_is_tan_beta_times_sin_tilt(beta, alpha, d):
    camera = looking_at_object(beta, alpha, d)
    assert camera.slope(ORIGIN, ALONG_EDGE) == pytest.approx(math.tan(beta) * math.sin(camera.tilt_rad), abs=1e-9)


@given(betas, alphas, distances_m)
def test_slope_below_the_centre_grows_with_the_row(beta, alpha, d):
    """Slope at row v of a line parallel to the edge: tan(beta) (sin(tilt) + v/f cos(tilt)), where u = 0."""
    camera = looking_at_object(beta, alpha, d)
    below = np.array((0.0, 0.0, -0.07))
    v_px = camera.project(below[None])[0, 1]
    expected = math.tan(beta) * (math.sin(camera.tilt_rad) + v_px / FOCAL_PX * math.cos(camera.tilt_rad))
    assert camera.slope(below, ALONG_EDGE) == pytest.approx(expected, abs=1e-9)


@given(betas, distances_m)
def test_slope_is_the_secant_of_two_projected_points(beta, d):
    camera = looking_at_object(beta, 0.3, d)
    near, far = camera.project(np.array(((-0.05, -0.02, -0.07), (-0.05, 0.02, -0.07))))
    slope = camera.slope(np.array((-0.05, 0.0, -0.07)), ALONG_EDGE)
    assert (far[1] - near[1]) / (far[0] - near[0]) == pytest.approx(slope, rel=1e-6, abs=1e-6)


def test_left_is_negative_u_and_low_is_positive_v():
    camera = Camera(0, 0, 0, 0, 0, FOCAL_PX)
    left_and_low = camera.project(np.array(((2.0, 1.0, -0.5),)))[0]
    assert left_and_low == pytest.approx((-FOCAL_PX / 2, FOCAL_PX / 4))


def test_panning_left_moves_the_image_right():
    turned = Camera(0, 0, 0, 5 * DEG, 0, FOCAL_PX)
    assert turned.project(np.array(((1.0, 0.0, 0.0),)))[0, 0] == pytest.approx(FOCAL_PX * math.tan(5 * DEG))


def test_tilting_down_moves_the_image_up():
    lowered = Camera(0, 0, 0, 0, 5 * DEG, FOCAL_PX)
    assert lowered.project(np.array(((1.0, 0.0, 0.0),)))[0, 1] == pytest.approx(-FOCAL_PX * math.tan(5 * DEG))


def test_points_behind_the_camera_have_no_pixel():
    behind = Camera(0, 0, 0, 0, 0, FOCAL_PX).project(np.array(((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0))))
    assert np.isnan(behind).all()


@given(st.floats(-3, 3), st.floats(0, 1.5), st.floats(-160, 160), st.floats(-120, 120))
def test_a_point_on_the_ray_of_a_pixel_projects_to_that_pixel(yaw, tilt, u, v):
    camera = Camera(-1.0, 0.4, 0.45, yaw, tilt, FOCAL_PX)
    ray = camera.rays(np.array(((u, v),)))
    assert np.linalg.norm(ray) == pytest.approx(1.0)
    assert camera.project(camera.position + 1.7 * ray)[0] == pytest.approx((u, v), abs=1e-6)


@given(st.floats(-3, 3), st.floats(0, 1.5))
def test_axes_are_a_right_handed_frame(yaw, tilt):
    right, down, forward = Camera(0, 0, 0, yaw, tilt, FOCAL_PX).axes
    assert np.cross(right, down) == pytest.approx(forward, abs=1e-12)


def test_camera_turned_towards_a_point_sees_it_at_the_centre():
    point = np.array((0.3, -0.8, 0.1))
    yaw, tilt = Camera(-1.0, 0.2, 0.45, 0, 0, FOCAL_PX).towards(point)
    assert Camera(-1.0, 0.2, 0.45, yaw, tilt, FOCAL_PX).project(point[None])[0] == pytest.approx((0, 0), abs=1e-9)


def test_mount_turns_with_the_robot():
    camera = Mount(forward_m=0.1, left_m=0.02, up_m=0.4, yaw_rad=0.05).camera((1.0, 2.0, 90 * DEG), 0.1, 0.2, FOCAL_PX)
    assert camera.position == pytest.approx((0.98, 2.1, 0.4))
    assert camera.yaw_rad == pytest.approx(90 * DEG + 0.15)
