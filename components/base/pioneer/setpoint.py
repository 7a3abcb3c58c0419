"""Speed and turn rate as the robot takes them: whole mm/s and whole deg/s. Pure."""

from __future__ import annotations

import math
from typing import NamedTuple


class SetPoint(NamedTuple):
    """Arguments of VEL and RVEL."""

    speed_mmps: int = 0
    turn_degps: int = 0


STILL = SetPoint()


class Limits(NamedTuple):
    """Of the robot, either way."""

    speed_mps: float
    turn_radps: float


class Rounding:
    """Rounds so that the mean over several commands is right: what one is too small, the next is larger."""

    def __init__(self) -> None:
        self._owed = (0.0, 0.0)

    def rounded(self, v_mps: float, omega_radps: float, limits: Limits) -> SetPoint:
        """The set-point for a wish; of one that is no number, rest."""
        if not (math.isfinite(v_mps) and math.isfinite(omega_radps)):
            v_mps = omega_radps = 0.0
        v = 1000.0 * min(max(v_mps, -limits.speed_mps), limits.speed_mps)
        turn = math.degrees(min(max(omega_radps, -limits.turn_radps), limits.turn_radps))
        wishes = tuple(wish + owed if wish else 0.0 for wish, owed in zip((v, turn), self._owed, strict=True))
        said = SetPoint(round(wishes[0]), round(wishes[1]))
        self._owed = (wishes[0] - said.speed_mmps, wishes[1] - said.turn_degps)
        return said
