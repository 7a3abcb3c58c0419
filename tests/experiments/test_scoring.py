"""Rows of docking times and their summary; controllers of many states against their one-state twins."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from docking import plant
from docking.angles import DEG
from docking.cells import Grid
from docking.linear import BEST_TUNED, Linear, teacher_table
from docking.task import Task
from experiments import ceiling, law_comparison, trajectories
from experiments.campaign import Options
from experiments.controller import docking_times
from experiments.docking_law import DockingLaw
from experiments.evaluation import World, law_times
from experiments.laws import docking, linear, tabled
from experiments.problem import Problem
from experiments.registry import EXPERIMENTS, load
from experiments.rows import Row
from experiments.scoring import Label, rows_of
from experiments.starts import Starts, protocol_starts
from experiments.summary import summary
from runtime.params import ConfigurationError

LABEL = Label("toy", "geometric", "lc", seed=4, robot_minutes=60.0)
STATES = np.random.default_rng(5).uniform((-1.1, -1.3, 0.3), (1.1, 1.3, 2.0), (40, 3))


def test_rows_are_the_mean_over_all_starts_and_then_each_distance() -> None:
    times = np.array([10.0, np.inf, 20.0, 30.0, np.inf, np.inf])
    whole, near, middle, far = rows_of(LABEL, times, 2.0, (1.0, 1.5, 2.0))
    assert (whole.start_distance_m, whole.controllable_percent, whole.docking_time_s) == (None, 50.0, 20.0)
    assert (near.controllable_percent, near.docking_time_s) == (50.0, 10.0)
    assert (middle.start_distance_m, middle.controllable_percent, middle.docking_time_s) == (1.5, 100.0, 25.0)
    assert (far.controllable_percent, far.docking_time_s) == (0.0, None)
    assert whole.robot_seconds_per_core_second == 30.0
    assert (whole.seed, whole.robot_minutes) == (4, 60.0)


def test_summary_shows_each_controller_once_with_its_last_minutes() -> None:
    early = Row("toy", "geometric", "rl", 0, 10.0, None, 5.0, 9.0, None)
    late = [dataclasses.replace(early, robot_minutes=60.0, seed=s, controllable_percent=20.0 + 2 * s) for s in (0, 1)]
    header, line = summary([early, *late])
    assert header == ("plant", "controller", "minutes", "seeds", "mean")
    assert line[:4] == ("geometric", "rl", "60", "2")
    assert line[4].startswith("21.0 +- 12.7 / 9.0")


def test_the_linear_law_of_many_states_is_that_of_one() -> None:
    law = Linear(*BEST_TUNED, 10 * DEG)
    v, omega = linear(law, 0.1)(*STATES.T)
    assert (v == 0.1).all()
    assert omega == pytest.approx([law.omega_radps(b, a) for b, a, _ in STATES])


def test_two_ways_of_driving_the_linear_law_agree() -> None:
    law, starts = Linear(*BEST_TUNED, 10 * DEG), protocol_starts()
    ours = docking_times(linear(law, 0.1), starts, Problem())
    assert np.array_equal(ours, law_times(World(Task()), law, starts))


def test_a_table_acts_by_its_cell_and_stands_outside() -> None:
    task, grid = Task(), Grid.of(Task())
    table = teacher_table(Linear(*BEST_TUNED, task.turn_rate_radps), grid, task.actions)
    v, omega = tabled(table, task)(*STATES.T)
    expected = [task.actions[table[grid.cell(b, a)]] for b, a, _ in STATES]
    assert np.stack([v, omega], axis=1) == pytest.approx(np.array(expected))
    out = tabled(table, task)(np.array([1.2]), np.array([0.0]), np.array([1.0]))
    assert (out[0][0], out[1][0]) == (0.0, 0.0)


@pytest.mark.parametrize("ahead_m", [0.0, 0.28])
def test_the_docking_law_is_asked_at_the_true_pose(ahead_m: float) -> None:
    law = DockingLaw()
    v, omega = docking(law, ahead_m)(*STATES.T)
    for n, state in enumerate(STATES):
        pose = tuple(np.array([x]) for x in plant.pose(*state))
        one = law.toward((-ahead_m, 0.0, 0.0), pose)
        assert (v[n], omega[n]) == pytest.approx((one[0][0], one[1][0]))


def test_docking_times_are_those_of_a_plain_loop_over_the_plant() -> None:
    law, grid = DockingLaw(constant_speed=True), Grid.of(Task())

    def time_s(beta: float, alpha: float, d: float) -> float:
        pose = plant.pose(beta, alpha, d)
        for sample in range(400):
            beta, alpha, d = plant.observe(*pose)
            if grid.cell(beta, alpha) < 0 or d < 0.2:
                return math.inf
            if grid.cell(beta, alpha) == grid.goal:
                return 0.125 * sample
            v, omega = law.toward((0.0, 0.0, 0.0), tuple(np.array([x]) for x in pose))
            pose = plant.advance(*pose, v[0], omega[0], 0.125)
        return math.inf

    whole = protocol_starts()
    starts = Starts(whole.beta_rad[::37], whole.alpha_rad[::37], whole.d_m[::37])
    expected = [time_s(*state) for state in zip(starts.beta_rad, starts.alpha_rad, starts.d_m, strict=True)]
    assert docking_times(docking(law, 0.0), starts, Problem()).tolist() == pytest.approx(expected)
    assert 0 < np.isfinite(expected).sum() < len(expected)


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_experiment_has_its_name_and_jobs_of_plain_values(name: str) -> None:
    experiment = load(name)
    jobs = experiment.jobs(Options(seeds=(3,)))
    assert name == experiment.NAME
    assert jobs
    assert all(isinstance(v, str | int | float | bool | None) for job in jobs for v in job.values())
    assert callable(experiment.run)
    assert callable(experiment.draw)


def test_an_unknown_experiment_is_named() -> None:
    with pytest.raises(ConfigurationError, match="experiment must be one of ceiling"):
        load("floor")


def test_the_ceiling_names_what_is_unlike_the_paper() -> None:
    options = Options(goal="dock", gripper_m=0.4, turn_rate_radps=5 * DEG, delay_samples=2)
    job = ceiling.jobs(options)[1]
    assert ceiling.name_of(job) == "two-speeds dock 0.4 m 5 deg/s delay 2"
    problem = ceiling.problem_of(job)
    assert problem.actions == ((0.1, 5 * DEG), (0.1, -5 * DEG), (0.05, 5 * DEG), (0.05, -5 * DEG))
    assert (problem.goal, problem.gripper_m, problem.delay_samples, problem.backup_samples) == ("dock", 0.4, 2, 2)


def test_the_pictures_of_the_ceiling_and_of_the_docking_law_are_drawn(tmp_path) -> None:
    rows = rows_of(Label("ceiling", "geometric", "one-speed cell driven"), np.full(10, 12.0), 1.0)
    made = [*ceiling.draw(rows, tmp_path), *law_comparison.draw(rows, tmp_path)]
    assert [path.name for path in made] == ["ceiling.png", "docking-law.png"]
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in made)


def test_trajectories_are_of_the_seed_that_was_asked_for() -> None:
    assert [job["seed"] for job in trajectories.jobs(Options(seeds=(7,)))] == [7]
