"""A camera beside the robot's axis, or turned on it, as far as one pose tells: no length, no calibration.

A camera at height h sees the object at a distance h / tan(tilt), so that all lengths are known in units of h. In the
pick-up pose the object is straight ahead of the axle and the heading is known. There the edge's slope tells how the
line camera-object runs, hence its bearing from the heading; pan tells the same bearing from the camera's own zero, and
what differs is the camera's yaw. The bearing and the distance tell how far aside the camera is.
How far the camera is ahead of the axle stays unknown: "axle" is the point of the axis beside the camera.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from docking.angles import wrap

_LEAST_TILT_RAD = 1e-3
"""Nothing on a table is seen flatter than this: 450 m away."""


class FromAxle(NamedTuple):
    """The object as a camera on the axis would see it that looks ahead at pan 0."""

    alpha_rad: float
    """Bearing from the heading."""
    tilt_rad: float
    turn_rad: float
    """What the line to the object turns by from camera to axle; adds to beta."""


@dataclass(frozen=True, slots=True)
class CameraOffset:
    """Where the camera is on the robot."""

    left: float = 0.0
    """Of the axis, in units of the camera's height above the object."""
    yaw_rad: float = 0.0
    """Direction of the camera at pan 0, from the heading."""

    @staticmethod
    def of_pick_up(line_rad: float, pan_rad: float, tilt_rad: float, heading_rad: float) -> CameraOffset:
        """From the pose in which the object is straight ahead of the axle.

        Args:
            line_rad: of the line camera-object against the table's normal, read from the slope of the edge.
            pan_rad: at which the camera sees the object.
            tilt_rad: as above.
            heading_rad: of the robot against the table's normal.
        """
        bearing_rad = line_rad - heading_rad
        return CameraOffset(-math.sin(bearing_rad) * _distance(tilt_rad), wrap(bearing_rad - pan_rad))

    def from_axle(self, pan_rad: float, tilt_rad: float) -> FromAxle:
        """Move the eye to the axle; a camera on the axis that looks ahead is there already."""
        if self.left == 0.0 and self.yaw_rad == 0.0:
            return FromAxle(pan_rad, tilt_rad, 0.0)
        bearing_rad, distance = pan_rad + self.yaw_rad, _distance(tilt_rad)
        ahead, left = distance * math.cos(bearing_rad), distance * math.sin(bearing_rad) + self.left
        alpha_rad = math.atan2(left, ahead)
        return FromAxle(alpha_rad, math.atan2(1.0, math.hypot(ahead, left)), wrap(alpha_rad - bearing_rad))


def _distance(tilt_rad: float) -> float:
    """In units of the camera's height."""
    return 1.0 / math.tan(max(tilt_rad, _LEAST_TILT_RAD))
