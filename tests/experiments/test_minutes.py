"""What a robot learns in minutes, short; and that its rows and tables say what they are."""

import csv
import dataclasses

import numpy as np
import pytest

from components.learner.perceptual import Planning
from experiments import minutes, minutes_mid_session, minutes_picture
from experiments.campaign import Options
from experiments.minutes_scoring import drives, grid_policy_times
from experiments.minutes_training import Trainee
from experiments.problem import Problem
from experiments.robot import ROBOTS, Drivetrain, poses_of
from experiments.rows import Row
from experiments.starts import demo_starts

COARSE = {"angle_step_rad": 0.06, "d_share": 0.25}


def trainee(robot="as built", method="structure-given", goal="dock", seed=0):
    return Trainee(ROBOTS[robot], Problem(goal=goal), Planning(method=method, **COARSE), seed)


def test_a_robot_that_is_never_put_anywhere_learns_its_numbers_in_half_a_minute():
    (lesson,) = trainee().lessons((0.5,))
    assert lesson.structure == "given, mirrored"
    assert lesson.policy.known > 0.3 * lesson.policy.action.size


def test_a_robot_that_changes_in_mid_session_is_learned_anew_and_its_goal_taken_over():
    robot = trainee()
    for _ in robot.lessons((0.5,)):
        robot.change(ROBOTS["camera aside"])
    (lesson,) = robot.lessons((1.5,))
    assert lesson.structure == "given, not mirrored"
    assert robot.learner.planner.limits == robot.limits != trainee().limits


def test_a_percept_runs_ahead_of_a_robot_that_turns_and_not_of_one_that_stands():
    robot, rng = ROBOTS["focal length x1.3"], np.random.default_rng(0)
    poses, drivetrain = poses_of(np.array([[0.2, 0.1, 1.5]])), Drivetrain(robot, 1)
    assert robot.percepts(poses, drivetrain.motions, rng) == pytest.approx(robot.seen(poses))
    poses = drivetrain.drive(poses, np.array([[0.0, 0.2]]), 0.125)
    ahead = robot.percepts(poses, drivetrain.motions, rng) - robot.seen(poses)
    assert ahead[0] == pytest.approx([0.0, -0.2 * robot.lead_s, 0.0])


def test_every_change_has_its_case_in_mid_session_and_its_own_ceiling():
    jobs = minutes_mid_session.jobs(Options(seeds=(0,), goal="dock"))
    assert len(jobs) == 12
    assert {minutes.job_name(job) for job in jobs} == {"minutes-mid-session"}
    assert minutes.problem_of(jobs[0]).limits.docking


def rows(monkeypatch):
    monkeypatch.setattr(minutes, "ceiling_times", lambda *_: np.full(961 * 5, 10.0))
    job = {**minutes.jobs(Options(seeds=(3,), minutes=0.3, goal="dock"))[0]}
    return [dataclasses.replace(row, seed=seed) for seed in (3, 4) for row in minutes.run(job)]


def test_the_table_compares_with_the_ceiling_seed_by_seed(monkeypatch, tmp_path):
    found = rows(monkeypatch)
    table, picture = minutes_picture.draw(found, tmp_path)
    (line,) = list(csv.DictReader(table.open(encoding="utf-8")))
    own = next(row for row in found if row.controller.startswith("structure-given: "))
    assert (line["seeds"], line["ceiling_percent"], line["robot_minutes"]) == ("2", "100", "0.3")
    assert float(line["median_share"]) == pytest.approx(own.controllable_percent / 100.0, rel=1e-3)
    assert float(line["median_time_ratio"]) == pytest.approx((own.docking_time_s or 0.0) / 10.0, rel=1e-3)
    assert picture.exists()


def test_who_reaches_the_goal_is_timed_by_when_it_is_there_and_drives_no_more():
    robot, problem, starts = ROBOTS["noisy percepts"], Problem(goal="dock"), demo_starts(6)
    (lesson,) = trainee().lessons((0.5,))
    times = grid_policy_times(lesson.policy, robot, problem, starts, np.random.default_rng(1))
    driven = list(drives(lesson.policy, robot, problem, starts, np.random.default_rng(1)))
    for n, time_s in enumerate(times):
        seen = [line.verdicts[line.robots == n][0] for line in driven if n in line.robots]
        assert (seen[-1] == 1) == np.isfinite(time_s)
        assert all(verdict == 0 for verdict in seen[:-1])
        assert not np.isfinite(time_s) or time_s == pytest.approx((len(seen) - 1) * problem.sampling_s)
    assert np.isfinite(times).any()


def test_the_failure_that_is_shown_is_the_worst_seed_after_a_minute():
    line = Row("minutes", "geometric", "x", 0, 1.0, None, 50.0, 12.0, None)
    worse = dataclasses.replace(line, seed=7, controllable_percent=30.0)
    later = dataclasses.replace(line, seed=8, robot_minutes=3.0, controllable_percent=20.0)
    assert minutes_picture.worst_seed([line, worse, later], "x", 1.0) == 7
    assert minutes_picture.worst_seed([line], "y", 1.0) is None
