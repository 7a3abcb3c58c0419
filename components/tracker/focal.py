"""The focal length in pixels per radian, from pictures of a resting object by a turning head."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from components.tracker.gaze import direction

SHORTEST_PX, LONGEST_PX = 50.0, 5000.0
"""A lens of 145 degrees at 320 columns, and a telescope at 1920."""
LEAST_TURN_RAD = math.radians(1.5)
"""Both axes must have turned this far."""
ITERATIONS = 6
"""Gauss-Newton converges in 3."""


class NonsenseError(ValueError):
    """The pixels do not move as a pan-tilt camera's do; the text says how."""


@dataclass
class Sample:
    """The object in one picture, and the encoders at its exposure."""

    pan_rad: float = 0.0
    tilt_rad: float = 0.0
    u_px: float = 0.0
    v_px: float = 0.0


def fit(samples: Sequence[Sample], residual_px: float) -> float:
    """Pixels per radian for which all samples show the object in one direction (least squares).

    Args:
        samples: of an object at rest, the head turned on both axes between them.
        residual_px: largest root mean square of what remains.

    Raises:
        NonsenseError: an axis did not turn, runs the wrong way, or the samples contradict each other.
    """
    start = [_linear(samples, "pan"), _linear(samples, "tilt")]
    inverse = 0.5 * sum(start)
    for _ in range(ITERATIONS):
        inverse -= _newton_step(samples, inverse)
        if not 1.0 / LONGEST_PX <= inverse <= 1.0 / SHORTEST_PX:
            raise NonsenseError(
                f"focal length out of {SHORTEST_PX:g}..{LONGEST_PX:g} px: the steps move the object wrongly"
            )
    rest = _spread(samples, inverse)
    rms_px = math.sqrt(sum(r * r for r in rest) / len(samples)) / inverse
    if rms_px > residual_px:
        raise NonsenseError(f"pixels disagree with one focal length by {rms_px:.1f} px; at most {residual_px:g} px")
    return 1.0 / inverse


def _linear(samples: Sequence[Sample], axis: str) -> float:
    """Radians per pixel by linear regression of one encoder on its pixels. To first order pan = b + q u / cos(tilt)."""
    encoder: Callable[[Sample], float] = (lambda s: s.pan_rad) if axis == "pan" else (lambda s: -s.tilt_rad)
    pixels = [s.u_px / max(math.cos(s.tilt_rad), 0.1) if axis == "pan" else s.v_px for s in samples]
    turns = [encoder(s) for s in samples]
    if max(turns) - min(turns) < LEAST_TURN_RAD:
        raise NonsenseError(f"{axis} did not turn")
    pixels, turns = _centred(pixels), _centred(turns)
    covariance = sum(p * t for p, t in zip(pixels, turns, strict=True))
    if covariance <= 0.0:
        raise NonsenseError(f"{axis} runs the wrong way: turning towards the object moves it further off")
    return covariance / sum(p * p for p in pixels)


def _newton_step(samples: Sequence[Sample], inverse: float) -> float:
    """Gauss-Newton step of the inverse focal length that brings the directions together."""
    h = 1e-4 * inverse
    here = _spread(samples, inverse)
    slopes = [
        (after - before) / (2.0 * h)
        for after, before in zip(_spread(samples, inverse + h), _spread(samples, inverse - h), strict=True)
    ]
    return sum(r * s for r, s in zip(here, slopes, strict=True)) / sum(s * s for s in slopes)


def _spread(samples: Sequence[Sample], inverse: float) -> list[float]:
    """How far each sample's direction lies from the mean one: across the line of sight, then along it, rad."""
    seen = [direction(s.u_px, s.v_px, s.pan_rad, s.tilt_rad, 1.0 / inverse) for s in samples]
    depressions = [depression for _, depression in seen]
    level = math.cos(sum(depressions) / len(seen))
    across = [bearing * level for bearing, _ in seen]
    return _centred(across) + _centred(depressions)


def _centred(values: list[float]) -> list[float]:
    mean = sum(values) / len(values)
    return [value - mean for value in values]
