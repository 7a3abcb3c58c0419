"""What one pick-up pose tells about the camera, against a pinhole camera that really sits there."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from docking import plant
from docking.angles import DEG
from docking.camera_offset import CameraOffset
from docking.cells import Grid
from docking.linear import BEST_TUNED, Linear
from docking.pinhole import Mount
from docking.task import Task

GRIPPER_M = 0.28
ORIGIN, ALONG_EDGE = np.zeros(3), np.array((0.0, 1.0, 0.0))
mounts = st.builds(
    Mount,
    left_m=st.floats(-0.1, 0.1),
    up_m=st.floats(0.3, 0.6),
    yaw_rad=st.floats(-10 * DEG, 10 * DEG),
)
betas, alphas, distances_m = st.floats(-60 * DEG, 60 * DEG), st.floats(-75 * DEG, 75 * DEG), st.floats(0.28, 2.5)


def percept(mount, pose):
    """(slope, pan_rad, tilt_rad) of the origin, by projection."""
    idle = mount.camera(pose, 0.0, 0.0, 364.0)
    yaw_rad, tilt_rad = idle.towards(ORIGIN)
    pan_rad = math.remainder(yaw_rad - idle.yaw_rad, 2 * math.pi)
    return mount.camera(pose, pan_rad, tilt_rad, 364.0).slope(ORIGIN, ALONG_EDGE), pan_rad, tilt_rad


def taught(mount, heading_rad=0.0, **fields):
    slope, pan_rad, tilt_rad = percept(mount, plant.pose(heading_rad, 0.0, GRIPPER_M))
    goal = {"goal_slope": slope, "goal_pan_rad": pan_rad, "goal_tilt_rad": tilt_rad, "goal_heading_rad": heading_rad}
    return Task(**goal, tilt_limit_rad=1.5, **fields)


def edge_on(mount, pose):
    """The camera looks along the table's edge, where no slope is."""
    camera = mount.camera(pose, 0.0, 0.0, 364.0)
    return abs(math.atan2(-camera.y_m, -camera.x_m)) > 80 * DEG


@given(mounts, st.floats(-30 * DEG, 30 * DEG))
def test_one_pose_tells_yaw_and_offset_of_the_camera_exactly(mount, heading):
    offset = taught(mount, heading).offset
    assert (offset.left * mount.up_m, offset.yaw_rad) == pytest.approx((mount.left_m, mount.yaw_rad), abs=1e-9)


@given(mounts, betas, alphas, distances_m)
def test_wherever_the_camera_is_the_axle_is_seen_at_its_own_beta_alpha_and_distance(mount, beta, alpha, d):
    pose = plant.pose(beta, alpha, d)
    if edge_on(mount, pose):
        return
    seen = taught(mount).seen(*percept(mount, pose))
    assert (seen.beta_rad, seen.alpha_rad) == pytest.approx((beta, alpha), abs=1e-7)
    assert mount.up_m / math.tan(seen.tilt_rad) == pytest.approx(d, rel=1e-7)


@given(mounts, betas, alphas, distances_m)
def test_of_two_mirrored_poses_the_cells_are_mirrored_and_the_linear_law_turns_the_other_way(mount, beta, alpha, d):
    task = taught(mount)
    grid, law = Grid.of(task), Linear(*BEST_TUNED, task.turn_rate_radps)
    poses = plant.pose(beta, alpha, d), plant.pose(-beta, -alpha, d)
    if any(edge_on(mount, pose) for pose in poses):
        return
    one, other = (task.seen(*percept(mount, pose)) for pose in poses)
    assert law.omega_radps(*one[:2]) == pytest.approx(-law.omega_radps(*other[:2]), abs=1e-6)
    row, column = (
        (angle + reach) * cells / (2 * reach)
        for angle, reach, cells in (
            (one.beta_rad, task.beta_range_rad, task.beta_cells),
            (one.alpha_rad, task.alpha_range_rad, task.alpha_cells),
        )
    )
    if min(abs(row - round(row)), abs(column - round(column))) > 1e-5:
        assert grid.cell(*other[:2]) == grid.mirrored(grid.cell(*one[:2]))


@given(mounts, st.floats(-40 * DEG, 40 * DEG), st.floats(0.2, 1.0))
def test_too_close_is_the_axle_s_distance_to_the_edge(mount, beta, d):
    nearest_m = 0.25
    task = Task(**{**vars_of(taught(mount)), "tilt_limit_rad": math.atan2(mount.up_m, nearest_m)})
    if abs(d * math.cos(beta) - nearest_m) > 1e-6:
        assert task.seen(*percept(mount, plant.pose(beta, 0.1, d))).too_close == (d * math.cos(beta) < nearest_m)


def vars_of(task):
    return {name: getattr(task, name) for name in Task.__dataclass_fields__}


@given(mounts, st.floats(-30 * DEG, 30 * DEG))
def test_the_arctan_reading_has_its_goal_at_the_origin_too(mount, heading):
    task = taught(mount, heading, beta_reading="arctan")
    goal = (task.goal_slope, task.goal_pan_rad, task.goal_tilt_rad)
    assert task.seen(*goal)[:3] == pytest.approx((0.0, 0.0, task.arrival_tilt_rad), abs=1e-9)


@given(st.floats(-3.0, 3.0), st.floats(0.01, 1.5))
def test_a_camera_on_the_axis_is_left_alone_to_the_last_bit(pan, tilt):
    assert CameraOffset().from_axle(pan, tilt) == (pan, tilt, 0.0)
    assert Task().offset == CameraOffset()


def test_without_the_offset_the_far_view_of_a_camera_aside_is_wrong_by_its_angle_at_the_goal():
    """Why subtracting the goal is not enough: 5 cm aside is 10 deg at the goal and 1.4 deg two metres away."""
    mount = Mount(left_m=0.05)
    slope, pan, tilt = percept(mount, plant.pose(0.0, 0.0, 2.0))
    task = taught(mount)
    assert (pan - task.goal_pan_rad) / DEG == pytest.approx(8.7, abs=0.1)
    assert task.seen(slope, pan, tilt).alpha_rad == pytest.approx(0.0, abs=1e-9)
