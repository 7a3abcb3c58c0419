"""Angles in radians."""

from __future__ import annotations

import math

DEG = math.pi / 180.0
"""Radians per degree."""


def wrap(angle_rad: float) -> float:
    """The same angle in (-pi, pi]."""
    return math.pi - (math.pi - angle_rad) % (2.0 * math.pi)
