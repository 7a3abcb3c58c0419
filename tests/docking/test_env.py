"""The Gymnasium environment: its own checker, the plant's steps, the ends of an episode."""

from __future__ import annotations

import math
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from docking import plant
from docking.angles import DEG
from docking.cells import Grid
from docking.env import GOAL_REWARD, ID, MAX_STEPS, SINK_REWARD, DockingEnv
from docking.task import Task

START = {"start": (0.3, -0.2, 1.5)}


@pytest.mark.parametrize("distance", [False, True])
def test_gymnasium_s_checker_finds_nothing(distance):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("docking.env:" + ID, distance=distance)
        check_env(env.unwrapped, skip_render_check=True)
    assert env.spec is not None
    assert env.spec.max_episode_steps == MAX_STEPS


def test_a_step_is_the_plant_s_exact_arc():
    env = DockingEnv(distance=True)
    env.reset(seed=1, options=START)
    pose = plant.pose(*START["start"])
    for action in (0, 1, 1, 0, 0):
        seen, reward, *_, info = env.step(action)
        pose = plant.advance(*pose, 0.1, (10 if action == 0 else -10) * DEG, 0.125)
        assert info["pose"] == pytest.approx(pose)
        assert seen == pytest.approx(plant.observe(*pose), abs=1e-6)
        assert reward == -1


def test_the_same_seed_gives_the_same_episode_and_another_seed_another():
    def episode(seed):
        env = DockingEnv(plant_noise=0.1)
        first, _ = env.reset(seed=seed)
        return [first.tolist(), *(env.step(k % 2)[0].tolist() for k in range(20))]

    assert episode(3) == episode(3)
    assert episode(3) != episode(4)


def test_starts_cover_the_ranges_outside_the_goal():
    env, grid = DockingEnv(distance=True), Grid.of(Task())
    starts = np.array([env.reset(seed=seed)[0] for seed in range(500)])
    assert np.abs(starts).max(axis=0) == pytest.approx([65 * DEG, 80 * DEG, 2.0], rel=0.03)
    assert starts[:, 2].min() == pytest.approx(1.0, abs=0.02)
    assert grid.goal not in {grid.cell(b, a) for b, a, _ in starts}


def test_entering_the_goal_cell_is_rewarded_and_terminates():
    env = DockingEnv()
    env.reset(options={"start": (0.0, 3.5 * DEG, 1.0)})
    steps = 0
    terminated = truncated = False
    while not terminated:
        _, reward, terminated, truncated, info = env.step(0)
        steps += 1
    assert (info["outcome"], reward, truncated) == ("goal", GOAL_REWARD - 1, False)
    assert steps == 1  # 1.25 deg of turn against 0.9 deg to the goal cell


@pytest.mark.parametrize("start", [(0.0, 79.5 * DEG, 1.0), (64.9 * DEG, 60 * DEG, 0.3), (0.1, 0.2, 0.205)])
def test_leaving_the_ranges_or_coming_too_close_is_the_sink(start):
    env = DockingEnv()
    env.reset(options={"start": start})
    _, reward, terminated, truncated, info = env.step(1)
    assert (info["outcome"], reward, terminated, truncated) == ("sink", SINK_REWARD - 1, True, False)


def test_an_endless_episode_is_truncated_not_terminated():
    env = gymnasium.make("docking.env:" + ID, actions=((0.0, 0.0),))
    env.reset(seed=0, options=START)
    ends = [env.step(0)[2:4] for _ in range(MAX_STEPS)]
    assert ends[-1] == (False, True)
    assert not any(truncated for _, truncated in ends[:-1])


def test_the_mirrored_start_under_mirrored_actions_is_the_mirrored_episode():
    env, image = DockingEnv(), DockingEnv()
    env.reset(options={"start": (0.4, -0.3, 1.4)})
    image.reset(options={"start": (-0.4, 0.3, 1.4)})
    for action in (0, 0, 1, 0, 1, 1):
        seen, reward, *_ = env.step(action)
        mirrored, its_reward, *_ = image.step(1 - action)
        assert mirrored == pytest.approx(-seen, abs=1e-6)
        assert its_reward == reward


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (math.nan, 0.0, 1.0), (0.0, 0.0)])
def test_a_bad_start_is_refused(start):
    with pytest.raises(ValueError, match=r"must be \(beta_rad, alpha_rad, d_m\)"):
        DockingEnv().reset(options={"start": start})
