"""Where a pixel lies, seen from the robot: exact for a pinhole camera whose pan axis is vertical.

Pan and bearings are positive to the left, tilts positive down; pixels u to the right, v down, from the image centre.
"""

from __future__ import annotations

import math

STEEPEST_RAD = math.radians(88.0)
"""Beyond this the edge is seen along itself."""


def direction(u_px: float, v_px: float, pan_rad: float, tilt_rad: float, focal_px: float) -> tuple[float, float]:
    """(bearing_rad, depression_rad) of the ray through a pixel of a camera at (pan, tilt)."""
    cos, sin = math.cos(tilt_rad), math.sin(tilt_rad)
    ahead = focal_px * cos - v_px * sin
    below = focal_px * sin + v_px * cos
    return pan_rad - math.atan2(u_px, ahead), math.atan2(below, math.hypot(u_px, ahead))


def slope_at_centre(
    slope: float, u_px: float, v_px: float, tilt_rad: float, focal_px: float, off_axis_rad: float, depression_rad: float
) -> float:
    """Slope dv/du that the table edge would show if the camera looked at the object and the edge ran through it.

    The edge is a horizontal line. Its image v = slope u + c spans a plane with the optical centre; this plane meets the
    horizontal one in the edge's direction, whose angle to the optical axis is the axis' angle to the table's normal.
    The object lies to the left of the axis by off_axis_rad, and at the image centre slope = tan(beta) sin(tilt).

    Args:
        slope: of the edge's image.
        u_px: column of the object.
        v_px: row at which the edge crosses that column.
        tilt_rad: of the camera.
        focal_px: pixels per radian.
        off_axis_rad: bearing of the object less the pan of the camera.
        depression_rad: of the object below the horizon.
    """
    offset_px = v_px - slope * u_px
    axis_rad = math.atan2(slope, math.sin(tilt_rad) + offset_px / focal_px * math.cos(tilt_rad))
    beta_rad = min(max(axis_rad + off_axis_rad, -STEEPEST_RAD), STEEPEST_RAD)
    return math.tan(beta_rad) * math.sin(depression_rad)
