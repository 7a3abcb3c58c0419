"""PD gains of the tracker for a head with this lag and a camera with this latency, by simulation of the one axis."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

P_TRIED = (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
D_TRIED = (0.0, 0.05, 0.1, 0.2, 0.3)
WORTH = 1.1
"""Gains are worth changing if the error of those in force is larger than the best by this factor."""
_FRAMES, _CYCLES = 48, 8
_RATE_RADPS = math.radians(10.0)
"""The object moves as the robot's turns make it, one way and then the other."""


class Gains(NamedTuple):
    """Of one axis."""

    p: float
    d: float


class Loop(NamedTuple):
    """One axis as it was measured."""

    lag_s: float
    latency_s: float
    """Of the camera against the encoder: the encoders are read at the exposure."""
    rate_radps: float
    frame_s: float
    noise_rad: float
    """Of the object's place."""


def best(loop: Loop) -> Gains:
    """The gains of the smallest error; P + D <= 1, so that the head never overshoots."""
    tried = [Gains(p, d) for p in P_TRIED for d in D_TRIED if p + d <= 1.0]
    return min(tried, key=lambda gains: error_rad(gains, loop))


def error_rad(gains: Gains, loop: Loop) -> float:
    """Root mean square of the object's angle from the image centre, without feed-forward."""
    noise = loop.noise_rad * np.random.default_rng(0).standard_normal(_FRAMES)
    cycle_s = loop.frame_s / _CYCLES
    share, reach = 1.0 - math.exp(-cycle_s / loop.lag_s), loop.rate_radps * cycle_s
    late = min(round(loop.latency_s / cycle_s), 4 * _CYCLES)
    angles, before, total = [0.0] * (late + 1), 0.0, 0.0
    for frame in range(_FRAMES):
        seen = angles[-1 - late]
        error = _object(frame * loop.frame_s - loop.latency_s) + float(noise[frame]) - seen
        target = seen + gains.p * error + gains.d * (error - before)
        before = error
        for _ in range(_CYCLES):
            angles.append(angles[-1] + min(max(share * (target - angles[-1]), -reach), reach))
        total += (_object((frame + 1) * loop.frame_s) - angles[-1]) ** 2
    return math.sqrt(total / _FRAMES)


def _object(time_s: float) -> float:
    """Its angle: to and fro, two seconds each way."""
    period_s = 4.0
    phase_s = max(time_s, 0.0) % period_s
    return _RATE_RADPS * (phase_s if phase_s < 0.5 * period_s else period_s - phase_s)
