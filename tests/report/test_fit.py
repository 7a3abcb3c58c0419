"""How well what was learned predicts: against a world in which the prediction is right, and one in which it is not."""

import math
import zlib

import numpy as np
import pytest

from docking.rates import RateModel
from docking.task import Task
from report.fit import FitReader
from runtime.recording import Logged
from schemas.drive_pb2 import Applied
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial

FRAME_NS = 125_000_000
CELLS, REWARD, GO = 31, 300.0, (0.1, 0.2)
TASK = Task()
KINEMATIC = np.zeros((3, 2, 3))
KINEMATIC[0, 0, 0] = KINEMATIC[1, 0, 0] = 2.0  # beta' = alpha' = 2 v sin(alpha) / d
KINEMATIC[2, 0, 1] = -2.0
KINEMATIC[1, 1, 2] = -1.0


def logged(policy):
    return Logged("learner/policy", "berth.Policy", policy.SerializeToString(), 1, 0, 0, 0)


def policy(value, fine=None):
    cells = CELLS * CELLS
    return Policy(
        version=3, beta_cells=CELLS, alpha_cells=CELLS, beta_range_rad=1.0, alpha_range_rad=1.0, action=bytes(cells),
        value=[value] * cells, action_v_mps=[0.1, 0.1], action_omega_radps=[0.2, -0.2], fine=fine,
    )  # fmt: skip


def fine(delay_samples=0.0):
    return Policy.Fine(
        beta_range_rad=1.0, alpha_range_rad=1.0, d_min=0.5, d_max=4.0, beta_nodes=3, alpha_nodes=3, d_nodes=2,
        action_zlib=zlib.compress(bytes(18)), functions="kinematic", theta=KINEMATIC.ravel(),
        delay_samples=delay_samples, noise=[0, 0, 0],
    )  # fmt: skip


def percept(beta, alpha, log_d):
    tilt = math.atan(math.exp(-log_d))
    return Percept(visible=True, slope=math.tan(beta) * math.sin(tilt), pan_rad=alpha, tilt_rad=tilt)


def reader(message):
    fit = FitReader({"components": [{"params": {"goal_reward": REWARD}}]}, TASK)
    fit.take_policy(logged(message))
    return fit


def drive(fit, frames, *, reached_at=None, version=3, controller="greedy"):
    for k in range(frames):
        reached = reached_at is not None and k >= reached_at
        fit.take(
            Trial(mode=Trial.APPROACH, controller=controller, policy_version=version, began_ns=1, goal_reached=reached),
            k * FRAME_NS,
        )
        fit.take(percept(0.3, 0.2, 1.0), k * FRAME_NS)
    return fit.fit()


def test_a_promise_is_the_goals_reward_less_a_sampling_period_each():
    (promise,) = drive(reader(policy(REWARD - 80)), 120, reached_at=100).promises
    assert promise.promised_s == pytest.approx(10.0)
    assert promise.took_s == pytest.approx(12.5)


def test_a_value_of_zero_promises_nothing_and_a_goal_that_is_not_reached_takes_for_ever():
    (promise,) = drive(reader(policy(0.0)), 20).promises
    assert math.isnan(promise.promised_s)
    assert math.isnan(promise.took_s)
    assert drive(reader(policy(200.0)), 20).kept == []


@pytest.mark.parametrize(("share", "promised_s"), [(0.97, 12.0), (0.2, math.nan)])
def test_a_forecast_is_about_the_pick_up_and_goes_before_the_cells(share, promised_s):
    fit = reader(policy(REWARD - 80))
    for k in range(120):
        mode = Trial.APPROACH if k < 90 else Trial.SERVO if k < 100 else Trial.GRASP
        trial = Trial(phase=Trial.EVALUATE, mode=mode, controller="greedy", policy_version=3, began_ns=1)
        trial.goal_reached = k > 80
        trial.dock_share, trial.dock_s = share, 12.0
        fit.take(trial, k * FRAME_NS)
        fit.take(percept(0.3, 0.2, 1.0), k * FRAME_NS)
    (promise,) = fit.fit().promises
    assert promise.promised_s == pytest.approx(promised_s, nan_ok=True)
    assert promise.took_s == pytest.approx(12.5)


@pytest.mark.parametrize("other", [{"version": 2}, {"controller": "lc"}])
def test_only_a_policy_that_is_in_the_file_and_drives_promises(other):
    assert drive(reader(policy(200.0)), 20, **other).promises == []


def motion(delay, driven_delay, frames=60):
    """Percepts of a world that moves exactly as the model says, its commands in force after a delay."""
    fit = reader(policy(1.0, fine(delay)))
    model = RateModel("kinematic", KINEMATIC)
    commands = [(0.1, 0.3 * math.sin(k / 5)) for k in range(frames)]
    state = np.array([[0.3, 0.2, 1.0]])
    for k in range(frames):
        fit.take_applied(Applied(v_mps=commands[k][0], omega_radps=commands[k][1]), k * FRAME_NS)
        fit.take(Trial(mode=Trial.APPROACH, controller="lc", began_ns=1), k * FRAME_NS)
        fit.take(percept(*state[0]), k * FRAME_NS)
        state = model.moved(state, np.array([commands[max(0, k - driven_delay)]]), 0.125)
    return fit.fit().motion


@pytest.mark.parametrize("delay", [0, 2])
def test_a_right_model_predicts_a_second_ahead_exactly(delay):
    found = motion(delay, delay)
    assert len(found.beta_rad) > 30
    assert max(*found.beta_rad, *found.alpha_rad, *found.distance_share) < 1e-3
    assert found.moved[1] > 0.05


def test_a_model_with_a_wrong_delay_does_not():
    assert motion(0, 3).alpha_rad.max() > 0.02


def test_cells_know_no_motion():
    assert drive(reader(policy(1.0)), 40).motion is None
