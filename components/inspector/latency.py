"""How late camera and encoders are, and pixels per radian, from steps of the head.

The motor's lag is found along with them: the encoders and the image must both fit what it makes of the commands. A dead
time of the motor itself can not be told from latency; it counts as both.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from components.inspector.servo import Array, Track, response

LONGEST_S = 0.4
"""Latencies up to this are found."""
LAGS_S = (0.005, 0.01, 0.02, 0.03, 0.045, 0.065, 0.1, 0.15)
"""Tried first; then what lies between the neighbours of the best."""
ENCODER_RAD, IMAGE_PX = 0.0008, 0.2
"""Expected errors of a reading and of the object's place: only their ratio matters."""


class Records(NamedTuple):
    """What was told and what was read, times in s."""

    pan: Track
    tilt: Track
    """Commands."""
    read_s: Array
    """`[N]`"""
    read_rad: Array
    """Encoders, pan and tilt, `[N, 2]`."""
    seen_s: Array
    """`[M]`"""
    seen_px: Array
    """The object, u and v, `[M, 2]`."""


class Fit(NamedTuple):
    """What explains the records best."""

    lag_s: float
    encoder_latency_s: float
    camera_latency_s: float
    focal_px: float
    encoder_gain: float
    """Angle read for an angle told."""
    encoder_rms_rad: float
    image_rms_px: float


class Servos(NamedTuple):
    """Motors as far as they are known."""

    cycle_s: float
    pan_rate_radps: float
    tilt_rate_radps: float


def fit(records: Records, servos: Servos, width_px: int) -> Fit:
    """The best of all lags to a millisecond, and the latencies that go with it."""
    best = min((_at_lag(records, servos, width_px, lag) for lag in LAGS_S), key=_cost)
    for step_s in (0.008, 0.004, 0.002, 0.001):
        beside = (best.lag_s - step_s, best.lag_s + step_s)
        tried = [_at_lag(records, servos, width_px, lag) for lag in beside if lag > 0.0]
        best = min((best, *tried), key=_cost)
    return best


def _cost(found: Fit) -> float:
    return (found.encoder_rms_rad / ENCODER_RAD) ** 2 + (found.image_rms_px / IMAGE_PX) ** 2


def _at_lag(records: Records, servos: Servos, width_px: int, lag_s: float) -> Fit:
    until_s = float(max(records.read_s[-1], records.seen_s[-1]))
    pan = response(records.pan, lag_s, servos.cycle_s, servos.pan_rate_radps, until_s)
    tilt = response(records.tilt, lag_s, servos.cycle_s, servos.tilt_rate_radps, until_s)

    def read(latency_s: float) -> tuple[float, float]:
        """(rms_rad, gain)."""
        time_s = records.read_s - latency_s
        return _gain(np.column_stack((pan.at(time_s), tilt.at(time_s))), records.read_rad)

    first_px = records.seen_px[0]
    guess = np.array((width_px, -first_px[0] / width_px, first_px[1] / width_px), dtype=np.float64)

    def seen(latency_s: float) -> tuple[float, float]:
        """(rms_px, focal_px)."""
        time_s = records.seen_s - latency_s
        return _focal(pan.at(time_s), tilt.at(time_s), records.seen_px, guess)

    encoder_s, (encoder_rms, gain) = _best(read)
    camera_s, (image_rms, focal) = _best(seen)
    return Fit(lag_s, encoder_s, camera_s, focal, gain, encoder_rms, image_rms)


def _best(cost: Callable[[float], tuple[float, float]]) -> tuple[float, tuple[float, float]]:
    """The latency of the smallest residual, to a millisecond, and what goes with it."""
    around_s, width_s = 0.5 * LONGEST_S, 0.5 * LONGEST_S
    for step_s in (0.02, 0.005, 0.001):
        tried = np.arange(max(around_s - width_s, 0.0), around_s + width_s + 1e-9, step_s).tolist()
        around_s = min(tried, key=lambda latency_s: cost(latency_s)[0])
        width_s = step_s
    return around_s, cost(around_s)


def _gain(told_rad: Array, read_rad: Array) -> tuple[float, float]:
    """One gain and an offset of each axis, least squares: (rms_rad, gain)."""
    told, read = told_rad - told_rad.mean(axis=0), read_rad - read_rad.mean(axis=0)
    gain = float((told * read).sum() / (told * told).sum())
    return float(np.sqrt(np.mean((read - gain * told) ** 2))), gain


def _focal(pan_rad: Array, tilt_rad: Array, seen_px: Array, guess: Array) -> tuple[float, float]:
    """Focal length and direction of a resting object, Gauss-Newton: (rms_px, focal_px)."""
    limits_px = 0.1 * guess[0], 10.0 * guess[0]
    solution = guess.copy()
    for _ in range(4):
        rest = (seen_px - projected(solution, pan_rad, tilt_rad)).ravel()
        columns = []
        for index, step in enumerate((1e-2, 1e-6, 1e-6)):
            moved = solution.copy()
            moved[index] += step
            columns.append(((seen_px - projected(moved, pan_rad, tilt_rad)).ravel() - rest) / step)
        solution -= np.linalg.lstsq(np.column_stack(columns), rest, rcond=None)[0]
        solution[0] = min(max(solution[0], limits_px[0]), limits_px[1])
    rest = seen_px - projected(solution, pan_rad, tilt_rad)
    return float(np.sqrt(np.mean(rest**2))), float(solution[0])


def projected(solution: Array, pan_rad: Array, tilt_rad: Array) -> Array:
    """Where an object in a direction is seen, `[N, 2]` px.

    Args:
        solution: focal_px, bearing_rad, depression_rad.
        pan_rad: of the camera, `[N]`.
        tilt_rad: of the camera, `[N]`.
    """
    focal_px, bearing_rad, depression_rad = solution.tolist()
    aside_rad = bearing_rad - pan_rad
    level, down = np.cos(depression_rad) * np.cos(aside_rad), np.sin(depression_rad)
    depth = np.cos(tilt_rad) * level + np.sin(tilt_rad) * down
    across = -np.cos(depression_rad) * np.sin(aside_rad)
    below = np.cos(tilt_rad) * down - np.sin(tilt_rad) * level
    return np.asarray(focal_px * np.column_stack((across / depth, below / depth)))
