"""How a percept moves: the learned form against the plant, and policies that come from strangers."""

import math

import numpy as np
import pytest

from docking import plant
from docking.angles import DEG
from docking.grid_policy import MOST_PAIRED, TRIED, UNKNOWN, Axes, GridPolicy, paired
from docking.percept_filter import PerceptFilter, predicted
from docking.rates import RateModel

HEIGHT_M = 0.45
PERIOD_S = 0.125


def unicycle(delay_samples=0.0, noise=(0.0, 0.0, 0.0)):
    """The rates of a camera on the axle, 0.45 m above the object."""
    theta = np.zeros((3, 2, 3))
    theta[0, 0, 0] = theta[1, 0, 0] = 1.0 / HEIGHT_M
    theta[2, 0, 1] = -1.0 / HEIGHT_M
    theta[1, 1, 2] = -1.0
    return RateModel("kinematic", theta, delay_samples, noise)


def driven(beta, alpha, d_m, v, omega, seconds):
    pose = plant.advance(*plant.pose(beta, alpha, d_m), v, omega, seconds)
    beta, alpha, d_m = plant.observe(*pose)
    return np.array([beta, alpha, math.log(d_m / HEIGHT_M)])


@pytest.mark.parametrize(("beta", "alpha", "d_m", "v", "omega"), [
    (0.3, -0.6, 1.5, 0.1, 0.17), (-0.5, 1.2, 0.8, 0.1, -0.17), (0.1, 0.2, 0.4, -0.1, 0.17), (0.0, 0.0, 2.0, 0.05, 0.0),
])  # fmt: skip
def test_a_unicycle_seen_from_its_axle_moves_as_the_plant_does(beta, alpha, d_m, v, omega):
    moved = unicycle().moved(np.array([[beta, alpha, math.log(d_m / HEIGHT_M)]]), np.array([[v, omega]]), PERIOD_S)
    assert moved[0] == pytest.approx(driven(beta, alpha, d_m, v, omega, PERIOD_S), abs=1e-6)


def test_a_robot_that_stands_sees_nothing_move():
    rates = unicycle().rates(np.array([[0.3, 0.4, 0.5]]), np.zeros((1, 2)))
    assert (rates == 0.0).all()


def test_a_late_command_is_predicted_from_the_ones_on_their_way():
    sent = [np.array([[0.1, 0.17]]), np.array([[0.1, -0.17]]), np.array([[0.1, 0.17]])]
    start = np.array([[0.3, -0.4, math.log(3.0)]])
    ahead = predicted(unicycle(2.0), start, sent, PERIOD_S)
    state = driven(0.3, -0.4, 3.0 * HEIGHT_M, 0.1, -0.17, PERIOD_S)
    state = driven(state[0], state[1], math.exp(state[2]) * HEIGHT_M, 0.1, 0.17, PERIOD_S)
    assert ahead[0] == pytest.approx(state, abs=1e-6)


def test_the_filter_halves_the_noise_of_percepts_and_more():
    noise = (2 * DEG, 1 * DEG, 0.05)
    rng = np.random.default_rng(5)
    count, errors, raw = 200, [], []
    tracker = PerceptFilter(unicycle(0.0, noise), count, PERIOD_S)
    poses = [plant.pose(0.4, -0.5, 1.8)] * count
    for _ in range(60):
        truth = np.array([plant.observe(*pose) for pose in poses])
        truth[:, 2] = np.log(truth[:, 2] / HEIGHT_M)
        seen = truth + rng.standard_normal(truth.shape) * noise
        errors.append(tracker.update(seen) - truth)
        raw.append(seen - truth)
        tracker.send(np.tile([0.1, -0.1], (count, 1)))
        poses = [plant.advance(*pose, 0.1, -0.1, PERIOD_S) for pose in poses]
    late = np.sqrt(np.mean(np.square(errors[30:]), axis=(0, 1)))
    assert (late < 0.5 * np.sqrt(np.mean(np.square(raw[30:]), axis=(0, 1)))).all()


def policy(action=None, **changed):
    axes = Axes(1.0, 1.2, 0.5, 4.0, 3, 5, 4)
    table = np.zeros(axes.shape, dtype=np.int8) if action is None else action
    values = {"axes": axes, "action": table, "actions": ((0.1, 0.2), (0.1, -0.2)), "model": unicycle(), **changed}
    return GridPolicy(**values)


def test_a_policy_looks_up_the_nearest_node():
    action = np.zeros((4, 5, 3), dtype=np.int8)
    action[2, 4, 0] = 1
    d = 0.5 + 2 * 3.5 / 3
    found = policy(action).act(np.array([[-0.9, 1.1, math.log(d)], [0.2, 1.1, math.log(d)], [2.5, 0.0, 0.0]]))
    assert found.tolist() == [1, 0, UNKNOWN]


def test_what_is_only_worth_trying_is_unknown_outside_training():
    tried = policy(np.full((4, 5, 3), TRIED - 1, dtype=np.int8))
    state = np.array([[0.0, 0.0, 0.0]])
    assert tried.act(state).tolist() == [UNKNOWN]
    assert tried.act(state, exploring=True).tolist() == [1]
    assert tried.known == 0


@pytest.mark.parametrize("actions", [1, 6, MOST_PAIRED])
def test_a_node_may_have_one_action_to_drive_and_another_to_try(actions):
    driven, tried = np.meshgrid(np.arange(-1, actions), np.arange(-1, actions), indexing="ij")
    axes = Axes(1.0, 1.0, 0.5, 1.0, 2, actions + 1, actions + 1)
    table = np.repeat(paired(driven.astype(np.int8), tried, actions)[:, :, None], 2, axis=2)
    both = GridPolicy(axes, table, ((0.1, 0.2),) * actions, unicycle())
    alpha, d = np.linspace(-1.0, 1.0, actions + 1), np.log(np.linspace(0.5, 1.0, actions + 1))
    states = np.array([(1.0, a, x) for x in d for a in alpha])
    assert both.act(states).tolist() == driven.ravel().tolist()
    assert both.act(states, exploring=True).tolist() == np.where(tried == UNKNOWN, driven, tried).ravel().tolist()
    assert both.known == 2 * np.count_nonzero(driven >= 0)


def test_a_state_that_is_no_number_has_no_action():
    assert policy().act(np.array([[math.nan, 0.0, 0.0], [0.0, 0.0, math.inf]])).tolist() == [UNKNOWN, UNKNOWN]


def test_a_policy_comes_back_from_its_bytes():
    action = np.random.default_rng(1).integers(-3, 2, (4, 5, 3)).astype(np.int8)
    whole = policy(action, version=7, method="structure-given", samples=12)
    again = GridPolicy.from_bytes(whole.to_bytes())
    assert again.to_bytes() == whole.to_bytes()
    assert (again.action == action).all()


@pytest.mark.parametrize(("changed", "words"), [
    ({"action": np.full((4, 5, 3), 2, dtype=np.int8)}, "action must be in"),
    ({"action": np.zeros((4, 5, 2), dtype=np.int8)}, "action must be"),
    ({"actions": ()}, "actions"),
    ({"actions": ((math.nan, 0.0),)}, "finite"),
    ({"axes": Axes(1.0, 1.2, 4.0, 0.5, 3, 5, 4)}, "d must grow"),
    ({"axes": Axes(9.0, 1.2, 0.5, 4.0, 3, 5, 4)}, "ranges"),
])  # fmt: skip
def test_a_policy_that_does_not_fit_together_is_refused(changed, words):
    with pytest.raises(ValueError, match=words):
        policy(**changed)


@pytest.mark.parametrize("theta", [np.zeros((3, 2, 4)), np.full((3, 2, 3), math.nan)])
def test_rates_that_are_no_rates_are_refused(theta):
    with pytest.raises(ValueError, match="theta"):
        RateModel("kinematic", theta)
