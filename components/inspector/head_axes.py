"""Which way pan and tilt turn, and what their encoders read, judged by the object's way in the image."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from components.inspector.judgement import Judgement, Verdict, scaled, unknown
from components.inspector.ports import Params
from components.inspector.sample import Sample, settled

LEAST_PX = 4.0
"""Less is no motion: half a degree of a usual lens."""
WIDEST, LONGEST = 0.35, 4.0
"""Plausible focal lengths in image widths: fields of view of 110 and 14 degrees."""
HEAD = "components.head"


class Way(NamedTuple):
    """What one nudge did, from its beginning to its end."""

    asked_rad: float
    image_px: float
    """Positive as a motion asked for should move the object."""
    read_rad: float
    """By the encoder."""


class Axis(NamedTuple):
    """Where one axis shows itself."""

    name: str
    zero: str
    """Phase that its nudges are compared with."""
    step_rad: float
    image: Callable[[Sample], float]
    encoder: Callable[[Sample], float]


def judge(samples: Sequence[Sample], params: Params) -> tuple[list[Judgement], float]:
    """Both axes; and the focal length in px that was seen, NaN if unknown."""
    axes = (
        Axis("pan", "pan 0", params.pan_step_rad, lambda s: s.u_px, lambda s: s.pan_rad),
        Axis("tilt", "tilt 0", params.tilt_step_rad, lambda s: -s.v_px, lambda s: s.tilt_rad),
    )
    found: list[Judgement] = []
    focals: list[float] = []
    for axis in axes:
        way = _way(samples, axis)
        judgements, focal_px = _axis(axis.name, way, params.width_px)
        found += judgements
        focals.append(focal_px)
    return found, next((focal for focal in focals if math.isfinite(focal)), math.nan)


def _way(samples: Sequence[Sample], axis: Axis) -> Way:
    """Of the nudge that moved the image more: the other one may have met an end stop."""
    ways = []
    for sign in (1, -1):
        phase = f"{axis.name} {'+' if sign > 0 else '-'}"
        image_px = settled(samples, phase, axis.image) - settled(samples, axis.zero, axis.image)
        read_rad = settled(samples, phase, axis.encoder) - settled(samples, axis.zero, axis.encoder)
        ways.append(Way(axis.step_rad, sign * image_px, sign * read_rad))
    return max(ways, key=lambda way: abs(way.image_px) if math.isfinite(way.image_px) else -1.0)


def _axis(name: str, way: Way, width_px: int) -> tuple[list[Judgement], float]:
    motor, encoder = f"{name} motor", f"{name} encoder"
    if not abs(way.image_px) > LEAST_PX:
        words = (
            f"told to turn by {math.degrees(way.asked_rad):.0f} deg, it did not move the image: no motor, or a unit?"
        )
        return [unknown(motor, words), unknown(encoder, words)], math.nan
    read = way.image_px / way.read_rad if way.read_rad else math.inf
    told = way.image_px / way.asked_rad
    if _plausible(read, width_px):
        ratio = math.copysign(abs(way.read_rad) / way.asked_rad, way.image_px)
        sign = math.copysign(1.0, read)
        return [
            scaled(motor, ratio, HEAD, f"{name}_scale"),
            scaled(encoder, sign, HEAD, f"{name}_encoder_scale"),
        ], abs(read)
    if not _plausible(told, width_px):
        words = f"{abs(told):.3g} px of image for a radian told, {abs(read):.3g} for one read: no lens is like that"
        return [unknown(motor, words), unknown(encoder, words)], math.nan
    good = scaled(motor, math.copysign(1.0, told), HEAD, f"{name}_scale")
    if not abs(way.read_rad) > 0.02 * way.asked_rad:
        return [good, Judgement(encoder, Verdict.WRONG, "it reads no motion while the image moves")], abs(told)
    true_rad = math.copysign(way.asked_rad, way.image_px)
    return [good, scaled(encoder, way.read_rad / true_rad, HEAD, f"{name}_encoder_scale", exact=True)], abs(told)


def _plausible(focal_px: float, width_px: int) -> bool:
    return WIDEST <= abs(focal_px) / width_px <= LONGEST
