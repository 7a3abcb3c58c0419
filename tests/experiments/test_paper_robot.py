"""The profile of the paper's own robot, and the distances that its ceiling is asked for."""

import math

import pytest

from experiments.paper_robot import DISTANCES_M, LAUNCH, PaperRobot, task
from experiments.problem import GRIPPER_M
from runtime.launch import load

CAMERA_M = 0.45


def test_cells_speeds_and_ranges_are_those_of_the_paper():
    own = task()
    assert (own.beta_cells, own.alpha_cells, own.speed_mps) == (15, 15, 0.05)
    assert [math.degrees(omega) for _, omega in own.actions] == pytest.approx([9.0, -9.0])
    assert [math.degrees(r) for r in (own.beta_range_rad, own.alpha_range_rad)] == pytest.approx([65.0, 80.0])


def test_it_reverses_until_the_tilt_is_below_20_degrees_which_is_95_centimetres():
    own = task()
    assert math.degrees(own.start_tilt_max_rad) == pytest.approx(20.0, abs=0.01)
    assert own.start_tilt_min_rad < own.start_tilt_max_rad
    assert CAMERA_M / math.tan(own.start_tilt_max_rad) == pytest.approx(0.95 + GRIPPER_M, abs=0.01)
    assert max(DISTANCES_M) == pytest.approx(0.95 + GRIPPER_M)


def test_the_ceiling_ends_at_20_centimetres_where_the_tilt_is_43_degrees():
    nearest_m = PaperRobot().limits.d_min_m
    assert nearest_m == pytest.approx(0.2 + GRIPPER_M)
    assert math.degrees(math.atan(CAMERA_M / nearest_m)) == pytest.approx(43.0, abs=0.5)


@pytest.mark.parametrize("name", ["paper-robot.toml", "peoplebot.toml"])
def test_the_robot_s_launch_files_are_whole(name):
    system = load(LAUNCH.with_name(name))
    assert system.clock == "real"
    assert system.component("base").device["kind"] == "pioneer"
    assert system.component("head").device["port"] == "unix:" + system.component("base").device["aux"]


def test_the_paper_s_launch_file_is_the_peoplebot_s_with_another_task_and_reverse_speed():
    ours, theirs = (load(LAUNCH.with_name(name)) for name in ("paper-robot.toml", "peoplebot.toml"))
    differing = {
        (a.name, key)
        for a, b in zip(ours.components, theirs.components, strict=True)
        for key in a.params
        if a.params[key] != b.params[key] and key != "task"
    }
    assert differing == {("pilot", "reverse_speed_mps")}
    assert [(c.name, c.run, c.device, c.inputs) for c in ours.components] == [
        (c.name, c.run, c.device, c.inputs) for c in theirs.components
    ]
