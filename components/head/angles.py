"""Pan-tilt cameras in their own steps: signs, limits, slew. Pure."""

from __future__ import annotations

import math
from typing import NamedTuple


class Scale(NamedTuple):
    """One axis: steps of the camera for a radian, and where it ends."""

    steps_per_rad: float
    low: int
    high: int

    def steps(self, angle_rad: float) -> int:
        """Nearest step that the camera can reach."""
        return min(max(round(angle_rad * self.steps_per_rad), self.low), self.high)

    def angle_rad(self, steps: int) -> float:
        """Of a step."""
        return steps / self.steps_per_rad


def per_degree(steps: float, low: int, high: int) -> Scale:
    """Scale of an axis that is described in degrees."""
    return Scale(math.degrees(steps), low, high)
