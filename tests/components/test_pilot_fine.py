"""Driving by a plan that knows the distance, on a perfect plant: where it may go, how it lands."""

import math
from functools import cache

import numpy as np
import pytest

from components.learner.perception import limits_of
from components.learner.planner import Planner, axes_of
from components.pilot.component import Pilot
from components.pilot.landing import has_landed, land
from components.pilot.ports import Params
from components.pilot.rules import Rules
from components.pilot.sight import Sight
from docking.cells import Grid
from docking.grid_policy import GridPolicy
from docking.plant import observe
from docking.policy import UNKNOWN, PolicyTable
from docking.rates import RateModel
from docking.task import Task
from schemas.drive_pb2 import Applied
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import DEG, HEIGHT_M, drive, frame, percept, tell

BACK_SAMPLES = 12
ROOM_RAD = (80 * DEG, 95 * DEG)
EDGE = ((0.3, -76 * DEG, 1.5), (-61 * DEG, 29 * DEG, 1.36), (56 * DEG, -33 * DEG, 1.2))
"""Starts from which the best way leads out of the task's ranges, or along their ends."""


def task(action_set):
    return Task(action_set=action_set, goal_tilt_rad=math.atan2(HEIGHT_M, 0.28), tilt_limit_rad=60 * DEG)


def unicycle():
    theta = np.zeros((3, 2, 3))
    theta[0, 0, 0] = theta[1, 0, 0] = 1.0 / HEIGHT_M
    theta[2, 0, 1], theta[1, 1, 2] = -1.0 / HEIGHT_M, -1.0
    return RateModel("kinematic", theta)


@cache
def planned(action_set, room_rad=ROOM_RAD):
    goal = task(action_set)
    limits = limits_of(goal, room_rad, docking=True)
    planner = Planner(limits, axes_of(limits, 2.5 * DEG, 0.13), np.array(goal.actions), 0.125, BACK_SAMPLES * 0.125)
    planner.begin(unicycle())
    planner.finish()
    fine = GridPolicy(planner.axes, planner.chosen(), goal.actions, unicycle(), back_samples=BACK_SAMPLES)
    grid = Grid.of(goal)
    return PolicyTable(
        grid, np.full(grid.count, UNKNOWN, np.int8), np.zeros(grid.count), goal.actions, fine=fine
    ).to_bytes()


def ends(action_set, starts, room_rad=ROOM_RAD):
    """Every frame of each trial, and the last one."""
    params = Params(
        task=task(action_set), train_s=0.0, evaluation_trials=len(starts), pick_up=False,
        policy=planned(action_set, room_rad),
    )  # fmt: skip
    trials = [[] for _ in starts]
    for seen in drive(params, 1, (0.3, 0.2, 1.7), 20_000, starts=lambda number: starts[number]):
        if seen.trial.mode != Trial.PLACE and seen.trial.number < len(starts):
            trials[seen.trial.number].append(seen)
    return trials


def docked(seen):
    return seen.gripper_error_m <= 0.02 and seen.heading_error_rad <= 4 * DEG


def test_a_robot_that_can_back_up_docks_from_everywhere():
    rng = np.random.default_rng(5)
    starts = [tuple(start) for start in rng.uniform((-1.1, -1.3, 1.0), (1.1, 1.3, 2.0), (12, 3)).tolist()]
    trials = ends("reverse", starts)
    assert [trial[-1].trial.outcome for trial in trials] == [Trial.ARRIVED] * len(starts)
    assert all(docked(trial[-1]) for trial in trials)
    assert any(seen.drive.v_mps < -0.05 for trial in trials for seen in trial)


def test_a_way_may_leave_the_ranges_of_the_task_but_not_of_the_plan():
    wide, narrow = ends("two-speeds", EDGE), ends("two-speeds", EDGE, room_rad=(0.0, 0.0))
    assert all(docked(trial[-1]) for trial in wide)
    assert max(abs(seen.alpha_rad) for trial in wide for seen in trial) > Task().alpha_range_rad
    assert sum(docked(trial[-1]) for trial in narrow) < len(EDGE)
    assert Trial.SINK in [trial[-1].trial.outcome for trial in narrow]


@pytest.mark.parametrize("side", [-1, 1])
def test_an_object_to_the_side_is_turned_to_before_it_is_approached(side):
    rules = Rules.of(Params(), 1)
    before = rules.task.arrival_tilt_rad - 3 * DEG
    wish = land(rules, Sight(True, 0.0, side * 12 * DEG, before))
    assert wish.v_mps == 0.0
    assert wish.omega_radps == pytest.approx(side * rules.task.turn_rate_radps)
    assert land(rules, Sight(True, 0.0, 0.0, before)).v_mps > 0.0


def test_at_the_pick_up_only_the_bearing_is_left_to_be_met_and_a_step_too_far_is_taken_back():
    rules = Rules.of(Params(), 1)
    there = rules.task.arrival_tilt_rad
    assert has_landed(rules, Sight(True, 0.02, 0.0, there))
    askew = Sight(True, 0.0, 3 * DEG, there)
    assert not has_landed(rules, askew)
    assert land(rules, askew).v_mps == 0.0
    assert land(rules, askew).omega_radps > 0.0
    assert land(rules, Sight(True, 0.0, 3 * DEG, there + 2 * DEG)).v_mps < 0.0


@pytest.mark.parametrize("beta_deg", [-3.4, -1.0, 2.0, 3.4])
@pytest.mark.parametrize("alpha_deg", [-18.0, -3.0, 7.0, 18.0])
def test_landing_docks_from_wherever_it_takes_over(beta_deg, alpha_deg):
    start = (beta_deg * DEG, alpha_deg * DEG, 0.33)
    assert observe(*_pose(start)) == pytest.approx(start)
    (trial,) = ends("reverse", (start,))
    assert {seen.trial.controller for seen in trial} <= {"servo", ""}
    assert docked(trial[-1])


def _pose(start):
    beta, alpha, d = start
    return -d * math.cos(beta), -d * math.sin(beta), beta - alpha


def test_where_base_refuses_the_way_back_the_law_drives_on():
    pilot = Pilot(Params(task=task("reverse"), train_s=0.0, policy=planned("reverse")), 1)
    aside = percept(0.5, 0.9, math.atan2(HEIGHT_M, 0.6))
    for k in range(4):
        wished, *_ = frame(pilot, k, aside)
    assert wished.v_mps < 0.0
    tell(pilot, "applied", Applied(commander="fence"), 3)
    driven, trial, _ = frame(pilot, 4, aside)
    assert driven.v_mps > 0.0
    assert trial.controller == "lc"
