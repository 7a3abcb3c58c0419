from __future__ import annotations

import json
import math

import numpy as np
import pytest

from docking.linear import BEST_TUNED, Linear, teacher_table
from docking.task import Task
from experiments import ablation, curves, schools, table2
from experiments.campaign import Options
from experiments.evaluation import World, law_times, score
from experiments.export import export, load_policy
from experiments.learners import BEST, HAND, LEARNERS, TEACHER, law
from experiments.rows import Row
from experiments.starts import protocol_starts
from experiments.training import Protocol, Training

SHORT = Options(seeds=(3,), minutes=0.3)
LEARNING = [table2, curves, ablation, schools]


def one_job_of_each_kind(experiment):
    """The first seeded job on each plant."""
    seeded = [job for job in experiment.jobs(SHORT) if job.get("seed") is not None]
    return [next(job for job in seeded if job["plant"] == plant) for plant in ("geometric", "printed")]


@pytest.mark.parametrize("experiment", LEARNING)
def test_jobs_are_plain_values_and_all_different(experiment):
    keys = [json.dumps(job, sort_keys=True) for job in experiment.jobs(Options())]
    assert len(set(keys)) == len(keys)


@pytest.mark.parametrize("experiment", LEARNING)
def test_the_same_job_gives_the_same_rows_but_for_their_speed_and_pictures_are_made(experiment, tmp_path):
    jobs = one_job_of_each_kind(experiment)
    rows = [row for job in jobs for row in experiment.run(job)]
    again = [row for job in jobs for row in experiment.run(job)]

    def facts(row):
        return {name: getattr(row, name) for name in Row.__slots__ if name != "robot_seconds_per_core_second"}

    assert [facts(row) for row in rows] == [facts(row) for row in again]
    assert {row.plant for row in rows} == {"geometric", "printed"}
    assert all(path.stat().st_size > 0 for path in experiment.draw(rows, tmp_path))


def test_every_learner_has_a_row_per_start_distance_and_one_for_their_mean():
    (job, _) = one_job_of_each_kind(table2)
    rows = [row for row in table2.run(job) if row.experiment == "table2"]
    for name in LEARNERS:
        mine = [row for row in rows if row.controller == name]
        shares = {row.start_distance_m: row.controllable_percent for row in mine}
        assert len(mine) == 6
        assert shares.pop(None) == pytest.approx(np.mean(list(shares.values())))


@pytest.mark.parametrize(("plant", "gains", "percent"), [("geometric", TEACHER, 44.5), ("printed", HAND, 45.2)])
def test_the_teachers_are_as_good_as_the_papers_linear_controller(plant, gains, percent):
    times = law_times(World(Task(), plant), law(gains[plant], Task()), protocol_starts())
    assert score(times).controllable_percent == pytest.approx(percent, abs=0.2)


@pytest.mark.parametrize("plant", ["geometric", "printed"])
def test_no_neighbour_in_the_grid_of_gains_is_better_than_the_best_tuned(plant):
    def percent(gains):
        return score(law_times(World(Task(), plant), law(gains, Task()), protocol_starts())).controllable_percent

    beta, alpha = BEST[plant]
    around = [(beta + i, alpha + j) for i in (-0.25, 0.0, 0.25) for j in (-0.25, 0.0, 0.25)]
    assert max(percent(gains) for gains in around) == percent(BEST[plant])


def test_a_curve_crosses_a_level_between_its_checkpoints():
    minutes, percent = np.array([10.0, 20.0]), np.array([20.0, 40.0])
    assert curves.crossing(minutes, percent, 30.0) == pytest.approx(15.0)
    assert curves.crossing(minutes, percent, 10.0) == pytest.approx(5.0)


def test_an_exported_policy_answers_as_the_table_does_and_the_law_where_nothing_was_learned(tmp_path):
    training = Training(protocol=Protocol(), seed=1)
    (checkpoint,) = training.checkpoints((3.0,))
    table = checkpoint.policy
    policy = load_policy(export(table, tmp_path, "RL-LC, motion model"))
    teacher = teacher_table(Linear(*BEST_TUNED, Task().turn_rate_radps), table.grid, table.actions)
    for cell in range(table.grid.count):
        known = table.act_in(cell)
        expected = table.actions[teacher[cell] if known is None else known]
        assert policy.act(*table.grid.centre(cell), 1.5) == expected
    assert policy.act(3.0, math.nan, 1.5) == (0.0, 0.0)
    assert 0 < table.known < table.grid.count


def test_a_file_that_is_no_policy_is_refused(tmp_path):
    path = tmp_path / "x.policy"
    path.write_bytes(b"hello")
    with pytest.raises(ValueError, match="policy"):
        load_policy(path)
