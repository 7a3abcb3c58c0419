"""Which way the wheels turn and drive the robot, and what the odometry reads, judged by the object in the image."""

from __future__ import annotations

import math
from collections.abc import Sequence

from components.inspector.judgement import Judgement, Verdict, has_name, scaled, unknown
from components.inspector.ports import Params
from components.inspector.sample import Sample, between, settled

BASE = "components.base"
LEAST_TURN = 0.2
"""A turn of less than this share of what was asked for is none."""
LEAST_PX = 0.35
"""Rows that the object must sink when the robot comes nearer."""
ASTRAY_RAD = math.radians(2.5)
"""A robot that turns by this while it is told to drive has one wheel the wrong way round."""
FARTHEST = 4.0
"""A way judged by the image is right within this factor."""


def judge(samples: Sequence[Sample], params: Params, focal_px: float) -> list[Judgement]:
    """Turn and drive.

    Args:
        samples: of the whole stage.
        params: what was asked for.
        focal_px: pixels per radian; NaN = unknown.
    """
    if not math.isfinite(focal_px):
        words = "not known while the head's motion is not understood"
        return [unknown(thing, words) for thing in ("turn", "heading", "drive", "odometry")]
    astray_rad = between(samples, "before the drive", "after the drive", lambda s: s.u_px) / focal_px
    if abs(astray_rad) > ASTRAY_RAD:
        words = f"told to drive, the robot turned by {math.degrees(astray_rad):.1f} deg: one wheel's motor is reversed"
        return [Judgement("drive", Verdict.WRONG, words)]
    turn = _turn(samples, params, focal_px)
    return [*turn, *_drive(samples, params, turn[1])]


def _turn(samples: Sequence[Sample], params: Params, focal_px: float) -> list[Judgement]:
    asked_rad = params.turn_rate_radps  # for one second
    image_rad = between(samples, "before the turn", "after the turn", lambda s: s.u_px) / focal_px
    read_rad = between(samples, "before the turn", "after the turn", lambda s: s.heading_rad)
    if not abs(image_rad) > LEAST_TURN * asked_rad:
        words = f"told to turn by {math.degrees(asked_rad):.0f} deg, it did not move the image: no motors, or a unit?"
        return [unknown("turn", words), unknown("heading", words)]
    turn = scaled("turn", image_rad / asked_rad, BASE, "turn_scale", exact=True)
    if not abs(read_rad) > 1e-3 * asked_rad:
        return [turn, Judgement("heading", Verdict.WRONG, "the odometry reads no turn while the image moves")]
    return [turn, scaled("heading", read_rad / image_rad, BASE, "heading_scale", exact=True)]


def _drive(samples: Sequence[Sample], params: Params, heading: Judgement) -> list[Judgement]:
    asked_m = params.speed_mps  # for one second
    sunk_px = _sunk(samples)
    row_px = abs(settled(samples, "before the drive", lambda s: s.v_px))
    if not abs(sunk_px) > LEAST_PX:
        words = f"told to drive {100 * asked_m:.0f} cm, it did not come nearer to the object: no motors, or a unit?"
        return [unknown("drive", words), unknown("odometry", words)]
    image_m = params.nearby_m * sunk_px / max(row_px, 1.0)
    drive = _roughly("drive", image_m / asked_m, "speed_scale")
    read_m = _way(samples, heading)
    if not abs(read_m) > 1e-3 * abs(image_m):
        return [drive, Judgement("odometry", Verdict.WRONG, "it reads no way while the robot moves")]
    trusted = drive.verdict == Verdict.GOOD or drive.value == -1.0
    true_m = math.copysign(asked_m, image_m) if trusted else image_m
    odometry = scaled("odometry", read_m / true_m, BASE, "odometry_scale", exact=True)
    if odometry.verdict == Verdict.WRONG and abs(odometry.value) != 1.0 and not has_name(odometry.value):
        words = f"the way read is {read_m / true_m:.2f} of the way told: drive a metre and measure which is wrong"
        odometry = Judgement("odometry", Verdict.WRONG, words, read_m / true_m)
    return [drive, odometry]


def _roughly(thing: str, ratio: float, param: str) -> Judgement:
    """The image tells the sign, and the unit only by its power of ten: nobody has measured how far the object is."""
    rough = math.copysign(1.0, ratio) if 1.0 / FARTHEST < abs(ratio) < FARTHEST else ratio
    return scaled(thing, rough, BASE, param)


def _sunk(samples: Sequence[Sample]) -> float:
    """Rows by which object and edge sank in the image."""
    rows = [
        between(samples, "before the drive", "after the drive", lambda s: s.v_px),
        between(samples, "before the drive", "after the drive", lambda s: s.edge_v_px),
    ]
    known = [row for row in rows if math.isfinite(row)]
    return sum(known) / len(known) if known else math.nan


def _way(samples: Sequence[Sample], heading: Judgement) -> float:
    """Along the heading, by the odometry as it reads."""
    factor = abs(heading.value) if heading.verdict == Verdict.WRONG and heading.value else 1.0
    heading_rad = factor * settled(samples, "before the drive", lambda s: s.heading_rad)
    dx_m = between(samples, "before the drive", "after the drive", lambda s: s.x_m)
    dy_m = between(samples, "before the drive", "after the drive", lambda s: s.y_m)
    return dx_m * math.cos(heading_rad) + dy_m * math.sin(heading_rad)
