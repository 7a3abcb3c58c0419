"""Percepts of a whole trial without their noise: filterpy's Kalman filter forwards, its smoother back."""

from __future__ import annotations

import numpy as np
from filterpy.common import Q_discrete_white_noise
from filterpy.kalman import KalmanFilter
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_VAGUE = 1e6


def smoothed(measured: Floats, expected: Floats, jerk: float = 0.3) -> Floats:
    """Columns `[N, 3]` without white noise.

    What a model expects is subtracted first; the rest is smoothed as a point of nearly constant velocity, all columns
    by one filter, since a filter of a column divided by its noise is the same for each.

    Args:
        measured: percepts.
        expected: their motion as a model expects it, from anywhere; zeros = there is no model.
        jerk: how fast the rest's velocity wanders, in standard deviations of the noise per sample squared.
    """
    rest = measured - expected
    kalman = KalmanFilter(dim_x=2, dim_z=1)
    kalman.F = np.array([[1.0, 1.0], [0.0, 1.0]])
    kalman.H = np.array([[1.0, 0.0]])
    kalman.R = np.ones((1, 1))
    kalman.Q = Q_discrete_white_noise(2, 1.0, jerk**2)
    kalman.x = np.stack([rest[0], np.zeros(rest.shape[1])])
    kalman.P = np.diag([_VAGUE, _VAGUE])
    kalman.inv = np.reciprocal
    means, covariances = [], []
    for row in rest:
        kalman.predict()
        kalman.update(row.reshape(1, -1), H=kalman.H)  # named: without it filterpy refuses more than one column
        means.append(kalman.x.copy())
        covariances.append(kalman.P.copy())
    states, *_ = kalman.rts_smoother(np.array(means), np.array(covariances))
    return np.asarray(states[:, 0] + expected)
