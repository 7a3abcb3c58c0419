"""Pinhole projection of a pan-tilt camera: points of the world to pixels, and back to rays.

World frame as in `docking.plant`, with z up: origin at the centre of the object. Pixels: u to the right, v down, from
the image centre. Yaw and pan are positive to the left, tilt positive down. Both axes of the head cross the optical
centre, so that turning the head does not move the camera.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Mount:
    """Where the camera sits on the robot."""

    forward_m: float = 0.0
    """Optical centre ahead of the axle."""
    left_m: float = 0.0
    """Optical centre to the left of the robot's axis."""
    up_m: float = 0.45
    """Optical centre above the centre of the object."""
    yaw_rad: float = 0.0
    """Direction of the camera at pan 0, from the heading."""

    def camera(self, pose: tuple[float, float, float], pan_rad: float, tilt_rad: float, focal_px: float) -> Camera:
        """The camera of a robot at `pose` (x_m, y_m, heading_rad of the axle)."""
        x_m, y_m, heading_rad = pose
        cos, sin = math.cos(heading_rad), math.sin(heading_rad)
        return Camera(
            x_m + self.forward_m * cos - self.left_m * sin,
            y_m + self.forward_m * sin + self.left_m * cos,
            self.up_m,
            heading_rad + self.yaw_rad + pan_rad,
            tilt_rad,
            focal_px,
        )


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera without roll, distortion or skew."""

    x_m: float
    y_m: float
    z_m: float
    yaw_rad: float
    tilt_rad: float
    focal_px: float

    @property
    def position(self) -> Array:
        """Optical centre, world, `[3]` m."""
        return np.array((self.x_m, self.y_m, self.z_m))

    @property
    def axes(self) -> Array:
        """Unit vectors right, down and forward of the camera in the world, one a row, `[3, 3]`."""
        cos_yaw, sin_yaw = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        cos_tilt, sin_tilt = math.cos(self.tilt_rad), math.sin(self.tilt_rad)
        return np.array(
            (
                (sin_yaw, -cos_yaw, 0.0),
                (-cos_yaw * sin_tilt, -sin_yaw * sin_tilt, -cos_tilt),
                (cos_yaw * cos_tilt, sin_yaw * cos_tilt, -sin_tilt),
            )
        )

    def seen(self, points_m: Array) -> Array:
        """World points `[N, 3]` in the camera's frame: right, down, forward (depth), `[N, 3]` m."""
        return np.asarray((points_m - self.position) @ self.axes.T)

    def project(self, points_m: Array) -> Array:
        """Pixels `[N, 2]` of world points `[N, 3]`; nan for points that are not in front of the camera."""
        seen = self.seen(points_m)
        depth = np.where(seen[:, 2:] > 0.0, seen[:, 2:], np.nan)
        return np.asarray(self.focal_px * seen[:, :2] / depth)

    def rays(self, pixels: Array) -> Array:
        """Unit directions in the world `[N, 3]` of pixels `[N, 2]`."""
        local = np.column_stack((pixels / self.focal_px, np.ones(len(pixels))))
        rays = local @ self.axes
        return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))

    def slope(self, point_m: Array, direction: Array) -> float:
        """Slope dv/du in the image of the world line through `point_m` `[3]` along `direction` `[3]`.

        A line parallel to the table's edge that is seen at the image centre has the slope tan(beta) sin(tilt).
        """
        right, down, depth = self.axes @ (point_m - self.position)
        along_right, along_down, along_depth = self.axes @ direction
        return float((along_down * depth - down * along_depth) / (along_right * depth - right * along_depth))

    def towards(self, point_m: Array) -> tuple[float, float]:
        """(yaw_rad, tilt_rad) that bring `point_m` `[3]` to the image centre."""
        x_m, y_m, z_m = (float(value) for value in point_m - self.position)
        return math.atan2(y_m, x_m), math.atan2(-z_m, math.hypot(x_m, y_m))
