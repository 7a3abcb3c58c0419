"""Whether a first, small motion of the wheels went much further than told: then nothing larger is tried."""

from __future__ import annotations

import math
from collections.abc import Sequence

from components.inspector import head_axes
from components.inspector.ports import Params
from components.inspector.sample import Sample, between, settled

FACTOR = 3.0
"""More than this times what was told is a wrong unit; less is found by the motion itself."""
_UNSEEN_M, _SLACK_M = 0.006, 0.002
"""Ways that the image does not show from 2 m, a quarter of a row; and that an odometry may round away."""
_SLACK_RAD = math.radians(0.8)


def drove_too_far(samples: Sequence[Sample], before: str, after: str, told_m: float, params: Params) -> str:
    """Why the robot must not drive on; empty = it may.

    The odometry may be what is wrong: it counts only if the image has moved, too.
    """
    seen_m, far_m = _nearer_m(samples, before, after, params), FACTOR * told_m
    dx_m, dy_m = (between(samples, before, after, what) for what in (lambda s: s.x_m, lambda s: s.y_m))
    if not seen_m > _UNSEEN_M or not (seen_m > far_m + _UNSEEN_M or math.hypot(dx_m, dy_m) > far_m + _SLACK_M):
        return ""
    return f"told to drive {1e3 * told_m:.0f} mm, the robot went {1e3 * seen_m:.0f}: is base.speed_scale right?"


def turned_too_far(samples: Sequence[Sample], before: str, after: str, told_rad: float, params: Params) -> str:
    """As above, for a turn, by the image alone."""
    focal_px = head_axes.judge(samples, params)[1]
    if not math.isfinite(focal_px):
        focal_px = head_axes.WIDEST * params.width_px
    turned_rad = abs(between(samples, before, after, lambda s: s.u_px)) / focal_px
    if not turned_rad > FACTOR * told_rad + _SLACK_RAD:
        return ""
    told_deg, turned_deg = math.degrees(told_rad), math.degrees(turned_rad)
    return f"told to turn by {told_deg:.1f} deg, the robot turned by {turned_deg:.0f}: is base.turn_scale right?"


def _nearer_m(samples: Sequence[Sample], before: str, after: str, params: Params) -> float:
    """By how much the robot came nearer to the object or went away, as object and edge tell; 0 if they are not seen."""
    ways_px = [abs(between(samples, before, after, what)) for what in (lambda s: s.v_px, lambda s: s.edge_v_px)]
    known = [way for way in ways_px if math.isfinite(way)]
    row_px = abs(settled(samples, before, lambda s: s.v_px))
    return params.nearby_m * sum(known) / len(known) / max(row_px, 1.0) if known else 0.0
