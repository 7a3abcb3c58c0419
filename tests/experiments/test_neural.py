from __future__ import annotations

import importlib.util
import warnings

import gymnasium
import pytest

from docking.env import ID
from docking.task import Task
from experiments import schools
from experiments.campaign import Options
from experiments.evaluation import World
from runtime.params import ConfigurationError

SHORT = Options(seeds=(0, 1), minutes=0.3, neural=True)
needs_torch = pytest.mark.skipif(
    importlib.util.find_spec("stable_baselines3") is None, reason="stable-baselines3 is not installed (extra `neural`)"
)


def test_without_the_package_one_error_names_the_command_that_installs_it(monkeypatch):
    monkeypatch.setattr(schools.importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(ConfigurationError, match=r"pip install --editable '\.\[neural\]'"):
        schools.jobs(SHORT)


def test_the_neural_learner_runs_only_when_asked_for():
    assert all(job["school"] != schools.NEURAL for job in schools.jobs(Options(seeds=(0,))))


@needs_torch
@pytest.mark.parametrize("distance", [False, True])
def test_stable_baselines3_s_checker_finds_nothing(distance):
    from stable_baselines3.common.env_checker import check_env  # noqa: PLC0415

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(f"docking.env:{ID}", distance=distance).unwrapped)


@needs_torch
def test_robot_time_of_the_neural_learner_counts_driving_and_every_way_back():
    from experiments.neural import HOLD_PERIODS, REVERSE_S, Held  # noqa: PLC0415

    env = Held(gymnasium.make(f"docking.env:{ID}"))
    env.reset(options={"start": (0.5, 0.3, 1.5)})
    env.step(0)
    assert env.robot_s == env.driven_s == HOLD_PERIODS * 0.125
    over = False
    while not over:
        *_, over, _truncated, _info = env.step(0)
    assert env.robot_s == pytest.approx(env.driven_s + REVERSE_S)


@needs_torch
def test_the_neural_learner_gives_rows_at_the_robot_times_asked_for_and_repeats_with_its_seed():
    from experiments import neural  # noqa: PLC0415

    rows, again = (neural.rows("schools", "DQN", World(Task(), seed=3), (0.5, 2.5)) for _ in range(2))
    assert [row.robot_minutes for row in rows] == [0.5] * 6 + [2.5] * 6
    assert [row.controllable_percent for row in rows] == [row.controllable_percent for row in again]
