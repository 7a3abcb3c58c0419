from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.learner.mean_filter import MeanFilter

VECTORS = st.lists(st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3), min_size=1, max_size=40)


def filtered(measurements, process_noise=0.0):
    mean, variance, kalman = np.zeros(len(measurements[0])), 0.0, MeanFilter(process_noise)
    for measured in measurements:
        mean, variance = kalman.update(mean, variance, np.array(measured))
    return mean, variance


@given(VECTORS)
def test_without_process_noise_it_is_the_running_average(measurements):
    mean, variance = filtered(measurements)
    np.testing.assert_allclose(mean, np.mean(measurements, axis=0), rtol=1e-9, atol=1e-9)
    assert variance == pytest.approx(1.0 / len(measurements))


def test_one_filter_serves_many_means_in_turn():
    kalman, rng = MeanFilter(), np.random.default_rng(1)
    data = rng.normal(size=(2, 30, 4))
    means, variances = np.zeros((2, 4)), [0.0, 0.0]
    for k in range(30):
        for which in range(2):
            means[which], variances[which] = kalman.update(means[which], variances[which], data[which, k])
    np.testing.assert_allclose(means, data.mean(axis=1), atol=1e-12)


@pytest.mark.parametrize("q", [0.001, 0.05, 1.0])
def test_with_process_noise_the_gain_settles_where_the_riccati_equation_says(q):
    steady = [[0.0]] * 400
    step, _ = filtered([*steady, [1.0]], q)
    assert step[0] == pytest.approx((-q + math.sqrt(q * q + 4.0 * q)) / 2.0, rel=1e-6)


def test_shares_that_sum_to_one_go_on_summing_to_one():
    rng = np.random.default_rng(2)
    exits = np.eye(9)[rng.integers(9, size=200)]
    mean, _ = filtered(exits, 0.02)
    assert mean.sum() == pytest.approx(1.0, abs=1e-12)
    assert (mean >= 0.0).all()
