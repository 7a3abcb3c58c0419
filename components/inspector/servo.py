"""What a head's motor makes of its commands: a first-order lag with a largest rate, computed in cycles."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Track(NamedTuple):
    """Angles at times."""

    time_s: Array
    """`[N]`, rising."""
    angle_rad: Array
    """`[N]`."""

    def at(self, time_s: Array) -> Array:
        """Between the two nearest times; at rest before the first and after the last."""
        return np.interp(time_s, self.time_s, self.angle_rad)


def response(commands: Track, lag_s: float, cycle_s: float, rate_radps: float, until_s: float) -> Track:
    """Where the motor is, cycle by cycle from the first command on.

    Args:
        commands: where it shall be from each time on.
        lag_s: time constant.
        cycle_s: a target is looked at this often, beginning with the first command.
        rate_radps: it turns no faster.
        until_s: end.
    """
    share, reach = 1.0 - math.exp(-cycle_s / lag_s), rate_radps * cycle_s
    count = math.floor((until_s - float(commands.time_s[0])) / cycle_s + 1e-6) + 1
    time_s = float(commands.time_s[0]) + cycle_s * np.arange(count, dtype=np.float64)
    newest = np.searchsorted(commands.time_s, time_s - 1e-6, side="left") - 1
    targets = commands.angle_rad[np.clip(newest, 0, None)].tolist()
    angle = targets[0]
    angles = [angle]
    for target in targets[1:]:
        angle += min(max(share * (target - angle), -reach), reach)
        angles.append(angle)
    return Track(time_s, np.array(angles))


def ramp_lag_s(lag_s: float, cycle_s: float) -> float:
    """How long the motor is behind a target that moves evenly: less than lag_s, because it looks a cycle ahead."""
    share = 1.0 - math.exp(-cycle_s / lag_s)
    return cycle_s * (1.0 - share) / share
