from __future__ import annotations

import numpy as np
import pytest

from components.learner.settings import Settings
from docking.linear import BEST_TUNED, HAND_TUNED, Linear
from docking.task import Task
from experiments.evaluation import World, law_times, policy_times, score
from experiments.starts import protocol_starts
from experiments.training import Protocol, Training
from runtime.params import ConfigurationError

TASK = Task()
STARTS = protocol_starts()


def trained(minutes=10.0, settings=None, protocol=None, seed=0):
    training = Training(TASK, settings or Settings(), protocol or Protocol(), seed)
    (checkpoint,) = training.checkpoints((minutes,))
    return training, checkpoint


@pytest.mark.parametrize(
    ("plant", "gains", "percent", "time_s"),
    [
        ("geometric", BEST_TUNED, 53.0, 14.8),
        ("geometric", HAND_TUNED, 18.0, 11.6),
        ("printed", (-1.5, 1.0), 45.2, 13.8),
    ],
)
def test_the_linear_controllers_reach_what_independent_prototypes_measured(plant, gains, percent, time_s):
    times = law_times(World(TASK, plant), Linear(*gains, TASK.turn_rate_radps), STARTS)
    assert score(times).controllable_percent == pytest.approx(percent, abs=0.1)
    assert score(times).docking_time_s == pytest.approx(time_s, abs=0.1)


def test_the_same_seed_learns_the_same_policy_and_another_seed_another():
    one, again, other = (trained(5.0, seed=seed)[1].policy for seed in (1, 1, 2))
    assert one.to_bytes() == again.to_bytes()
    assert one.table_sha256 != other.table_sha256


def test_robot_time_is_what_was_driven_and_the_fee_of_every_way_back():
    training, checkpoint = trained(5.0, protocol=Protocol(reverse_s=7.0))
    assert training.robot_s == pytest.approx(training.driven_s + 7.0 * training.trials)
    assert 300.0 <= training.robot_s < 400.0
    assert checkpoint.driven_s == training.driven_s


def test_after_forty_minutes_no_known_pair_leads_back_to_its_own_cell():
    """Storing the mean of absolute successors gave 23 % of such self-loops here."""
    training, checkpoint = trained(40.0, protocol=Protocol(cycle=("lc", "random"), teacher=BEST_TUNED))
    model = training.method.model
    cells = np.arange(len(model.degree)) // 2
    weights = np.where(model.successor == cells[:, None], model.weight, 0.0)
    used = np.arange(model.weight.shape[1]) < model.degree[:, None]
    assert weights[used].max() == 0.0
    assert checkpoint.policy.known > 900
    assert score(policy_times(World(TASK), checkpoint.policy, STARTS)).controllable_percent > 35.0


def test_teaching_alternates_trial_by_trial():
    training = Training(TASK, Settings(), Protocol(cycle=("lc", "random")), 0)
    drivers = []
    for _ in range(4):
        drivers.append(training._controller())
        training.trial()
    assert drivers == ["lc", "random", "lc", "random"]


def test_easy_missions_begin_near_the_goal_and_end_anywhere():
    training = Training(TASK, Settings(), Protocol(easy_minutes=10.0), 0)
    early = np.abs([training._start() for _ in range(200)]).max(axis=0)
    training.robot_s = 600.0
    late = np.abs([training._start() for _ in range(200)]).max(axis=0)
    assert (early[:2] <= 0.101 * np.array([TASK.beta_range_rad, TASK.alpha_range_rad])).all()
    assert (late[:2] > 0.9 * np.array([TASK.beta_range_rad, TASK.alpha_range_rad])).all()


@pytest.mark.parametrize(("robot_s", "share"), [(0.0, 0.8), (900.0, 0.6), (3600.0, 0.0), (9000.0, 0.0)])
def test_the_share_of_random_actions_falls_linearly_to_none(robot_s, share):
    training = Training(TASK, Settings(), Protocol(explore=0.8, explore_minutes=60.0), 0)
    training.robot_s = robot_s
    assert training._explore() == pytest.approx(share)
    assert Training(TASK, Settings(), Protocol(explore=0.8), 0)._explore() == 0.8


@pytest.mark.parametrize("wrong", [{"plant": "flat"}, {"cycle": ("magic",)}])
def test_a_protocol_of_unknown_words_is_refused(wrong):
    with pytest.raises(ConfigurationError, match=r"protocol\."):
        Protocol(**wrong)
