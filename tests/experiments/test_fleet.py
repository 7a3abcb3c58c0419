"""Robots that share a learner, short; and that the launch file's robots are the experiment's."""

from pathlib import Path

import numpy as np
import pytest

from components.learner.perceptual import Planning
from experiments import fleet
from experiments.campaign import Options
from experiments.fleet_training import SPREAD, Build, Fleet, drawn
from experiments.minutes_training import Trainee
from experiments.problem import Problem
from experiments.robot import Robot
from experiments.rows import Row
from runtime.launch import load

LAUNCH = Path(__file__).parent.parent.parent / "launch" / "fleet.toml"
PLANNING = Planning(angle_step_rad=0.06, d_share=0.25)
CASE = "structure-learned, noisy percepts, cell"


def test_robots_differ_by_no_more_than_the_spread_and_are_always_the_same():
    factors = np.array(drawn())
    assert (np.abs(factors - 1.0) <= SPREAD).all()
    assert np.ptp(factors, axis=0).min() > 0.05
    assert drawn() == drawn()


def test_the_robots_of_the_launch_file_are_those_that_were_drawn():
    system = load(LAUNCH)
    for number, build in enumerate(drawn(), start=1):
        suffix = "" if number == 1 else f"_{number}"
        world, tracker = (system.component(f"{name}{suffix}").params for name in ("simulator", "tracker"))
        wiring = world["wiring"]
        found = (wiring["forward"], wiring["turn"], world["camera_up_m"] / 0.45, world["focal_px"] / 364.0)
        assert found == pytest.approx(build, abs=1e-3)
        assert tracker["height_share"] == build.height


def test_what_a_robot_does_with_a_command_is_off_by_its_factors():
    robot = Build(speed=1.1, turn=0.9, height=1.05, focal=1.0).robot()
    assert robot.executed(np.array([[0.1, 0.2]])) == pytest.approx(np.array([[0.11, 0.18]]))


def test_a_fleet_of_one_learns_what_a_robot_learns():
    (lesson,) = Trainee(Robot(), Problem(), PLANNING, 0).lessons((0.5,))
    alone = Fleet([Robot()], Problem(), PLANNING, 0)
    ((minutes, _),) = alone.policies((0.5,))
    (trainee,) = alone.trainees
    trainee.plan()
    assert minutes == 0.5
    assert trainee.learner.policy().to_bytes() == lesson.policy.to_bytes()


def test_robots_share_the_minutes_and_start_from_different_places_and_each_has_a_policy():
    robots = Fleet([Robot(), Robot(turn_gain=0.9), Robot()], Problem(), PLANNING, 0)
    ((_, policies),) = robots.policies((0.6,))
    assert [trainee.samples for trainee in robots.trainees] == [96] * 3
    turns = [policy.model.rates(np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, 0.1]]))[0, 1] for policy in policies]
    assert turns == pytest.approx([-0.1, -0.09, -0.1], rel=0.03)
    assert len({trainee.rng.bit_generator.state["state"]["state"] for trainee in robots.trainees}) == 3


def rows(shares, who=fleet.ALONE, seed=0):
    for minutes, share in shares.items():
        yield Row("fleet", "geometric", f"{who}: {CASE}", seed, minutes, None, 60.0 * share, None, None)
        yield Row("fleet", "geometric", f"ceiling, {who}: {CASE}", seed, minutes, None, 60.0, None, None)


def test_the_share_is_reached_when_it_is_kept():
    found = [*rows({0.5: 0.95, 1.0: 0.8, 2.0: 0.91, 3.0: 0.92}), *rows({0.5: 0.99, 3.0: 0.89}, seed=4)]
    assert fleet.reached(found, f"{fleet.ALONE}: {CASE}", 0.9) == {0: 2.0, 4: float("inf")}


def test_the_table_compares_the_medians_and_the_picture_is_drawn(tmp_path):
    found = [row for seed in (0, 1, 2) for row in rows({1.0: 0.5, 2.0: 0.95 if seed else 0.5, 3.0: 0.95}, seed=seed)]
    found += rows({1.0: 0.5, 2.0: 0.5, 3.0: 0.95}, fleet.TOGETHER)
    lines = list(fleet.table(found))
    assert lines == [(CASE, share, 1, 2.0, 3.0, 1.5, 3.0) for share in (0.9, 0.95)]
    path, picture = fleet.draw(found, tmp_path)
    assert path.read_text(encoding="utf-8").splitlines()[1] == f'"{CASE}",0.9,1,2,3,1.5,3'
    assert picture.exists()


def test_every_robot_that_trained_is_driven_beside_its_ceiling(monkeypatch):
    monkeypatch.setattr(fleet, "MINUTES", (0.4,))
    monkeypatch.setattr(fleet, "Planning", lambda method: Planning(method, angle_step_rad=0.06, d_share=0.25))
    monkeypatch.setattr(fleet, "ceiling_times", lambda *_: np.full(len(fleet.some_starts()), 10.0))
    alone, together = (job for job in fleet.jobs(Options(seeds=(1,))) if job["percepts"] == "as built")
    assert fleet.robots_of(alone) == fleet.robots_of(together)[1:2]
    own, best = fleet.run(together)
    assert (own.robot_minutes, best.controllable_percent) == (0.4, 100.0)
    assert 0.0 < own.controllable_percent < 100.0
