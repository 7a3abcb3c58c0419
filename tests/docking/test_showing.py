"""What is seen in the pick-up pose becomes the goal, or is refused with the reason."""

import math
import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from docking.angles import DEG
from docking.showing import FEWEST_FRAMES, NotShownError, Percept, Showing
from docking.task import Task
from docking.task_file import FIELDS, task_text
from runtime.params import ConfigurationError, build

STILL = Percept(True, -0.15, -13 * DEG, 57 * DEG)
UNSEEN = Percept(False, 9.0, 9.0, 9.0)


def test_the_goal_is_the_mean_of_the_frames_in_which_the_object_is_seen():
    noise = np.random.default_rng(5).normal(0.0, 0.002, (40, 3))
    percepts = [Percept(True, *(np.array(STILL[1:]) + row).tolist()) for row in noise]
    showing = Showing.of([*percepts, *[UNSEEN] * 4])
    assert showing.mean == pytest.approx(np.array(STILL[1:]) + noise.mean(axis=0))
    assert showing.spread == pytest.approx(noise.std(axis=0))
    assert (showing.seen, showing.frames) == (40, 44)


@pytest.mark.parametrize(
    ("percepts", "words"),
    [
        ([], "at least 16 frames; got 0"),
        ([STILL] * (FEWEST_FRAMES - 1), "at least 16 frames; got 15"),
        ([UNSEEN] * 40, "seen in 80 % of the frames; they are in 0 of 40"),
        ([STILL] * 30 + [UNSEEN] * 10, "they are in 30 of 40"),
        ([STILL._replace(slope=math.nan)] * 40, "they are in 0 of 40"),
        ([STILL] * 20 + [STILL._replace(slope=-0.05)] * 20, "slope must not spread by more than 0.03"),
        ([STILL] * 20 + [STILL._replace(pan_rad=-15 * DEG)] * 20, "pan_rad must not spread by more than 0.00873"),
        ([STILL] * 20 + [STILL._replace(tilt_rad=55 * DEG)] * 20, "it spreads by 0.0175 over 40 frames"),
    ],
)
def test_too_few_frames_an_unseen_object_and_a_robot_that_moves_are_refused(percepts, words):
    with pytest.raises(NotShownError, match=words):
        Showing.of(percepts)


def test_a_robot_that_creeps_3_cm_is_refused():
    tilts = np.arctan2(0.45, np.linspace(0.295, 0.265, 40))
    with pytest.raises(NotShownError, match="tilt_rad must not spread"):
        Showing.of([STILL._replace(tilt_rad=float(tilt)) for tilt in tilts])


@given(st.floats(0.2, 1.2), st.floats(0.15, 0.6))
def test_the_tilts_keep_their_ratio_to_the_distance_of_the_goal(height_m, gripper_m):
    tilt = math.atan2(height_m, gripper_m)
    base = Task()
    task = Showing.of([Percept(True, 0.0, 0.0, tilt)] * 16).task(base)
    for name in ("tilt_limit_rad", "start_tilt_min_rad", "start_tilt_max_rad"):
        ratio = math.tan(getattr(base, name)) / math.tan(base.goal_tilt_rad)
        assert math.tan(getattr(task, name)) / math.tan(tilt) == pytest.approx(ratio, rel=1e-9)


def test_showing_the_goal_that_a_task_has_changes_nothing_else():
    base = Task(beta_cells=15, goal_heading_rad=0.2)
    goal = Percept(True, base.goal_slope, base.goal_pan_rad, base.goal_tilt_rad)
    again = Showing.of([goal] * 16).task(base)
    assert [getattr(again, name) for name in FIELDS] == pytest.approx([getattr(base, name) for name in FIELDS])
    assert again.beta_cells == 15


def test_a_goal_that_no_task_can_have_is_refused():
    with pytest.raises(ConfigurationError, match=r"goal.goal_tilt_rad must be between 0 and 1.57; got 2.0"):
        Showing.of([Percept(True, 0.0, 0.0, 2.0)] * 16).task(Task())


def test_a_goal_in_the_sink_is_refused():
    with pytest.raises(ConfigurationError, match=r"tilt_limit_rad must be larger than the tilt at the goal, 1.1"):
        Task(goal_tilt_rad=1.1)


def test_a_task_file_gives_back_every_number_to_the_last_bit():
    showing = Showing.of([STILL] * 16)
    task = showing.task(Task(), 0.1)
    fields = tomllib.loads(task_text(task, showing, ["Taught somewhere"]))
    assert build(Task, fields, "file") == task
    assert set(fields) == set(FIELDS)
