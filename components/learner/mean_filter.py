"""The model's filter: one filterpy Kalman filter, lent to every (cell, action) in turn."""

from __future__ import annotations

import numpy as np
from filterpy.kalman import KalmanFilter
from numpy.typing import NDArray


class MeanFilter:
    """A vector that drifts as a random walk and is measured with noise; all entries share one scalar variance.

    Everything is in units of the measurement's variance. The first measurement is taken as it is. Without process
    noise the gain of measurement n is then 1/n: the filter is the running average that the paper's model keeps.
    With process noise q the gain never falls below about sqrt(q), and old experience fades.

    filterpy's filter has one state here; its `x` is a row, one column per entry, which its matrix products carry
    through unchanged. So an update of ten entries costs what an update of one costs.
    """

    def __init__(self, process_noise: float = 0.0) -> None:
        self._kalman = KalmanFilter(dim_x=1, dim_z=1)
        self._kalman.R = np.ones((1, 1))
        self._kalman.Q = np.full((1, 1), process_noise)
        self._kalman.inv = np.reciprocal  # the inverse of a 1 x 1 matrix; numpy's general one costs 5 us more
        self._H = np.ones((1, 1))

    def update(
        self, mean: NDArray[np.float64], variance: float, measured: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], float]:
        """Mean [entries] and variance after a measurement [entries]; a variance of 0 says that there was none yet."""
        if variance == 0.0:
            return measured, 1.0
        kalman = self._kalman
        kalman.x = mean.reshape(1, -1)
        kalman.P = np.array([[variance]])
        kalman.predict()
        kalman.update(measured.reshape(1, -1), H=self._H)
        return kalman.x[0], float(kalman.P[0, 0])
