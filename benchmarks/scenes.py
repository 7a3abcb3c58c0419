"""Rendered, disturbed images of the table from everywhere, with what a perfect eye would see in each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from components.simulator import scene
from components.simulator.paint import Painter
from components.simulator.params import Params
from components.simulator.sensor import Sensor
from docking import plant
from docking.angles import DEG
from docking.pinhole import Array, Camera

AWAY_M = np.array((0.0, 0.0, 60.0))
"""An object there is in no image."""
ORIGIN_M = np.zeros(3)
SLACK_PX = 3.0
WIDEST_RAD = 65 * DEG
NEAREST_M, FARTHEST_M = 0.27, 2.0


class View(NamedTuple):
    """One image and the camera that it was taken with."""

    data: bytes
    camera: Camera


class Room:
    """Takes images in one simulated room."""

    def __init__(self, params: Params) -> None:
        self.params = params
        self._painter, self._sensor = Painter(params), Sensor(params, 1)

    def camera(self, beta_rad: float, d_m: float, pan_rad: float = 0.0, tilt_rad: float = 0.0) -> Camera:
        """Of a robot that looks at the object, turned away by pan and tilt."""
        x_m, y_m, heading_rad = plant.pose(beta_rad, 0.0, d_m)
        up_m = self.params.camera_up_m
        down_rad = math.atan2(up_m, d_m) + tilt_rad
        return Camera(x_m, y_m, up_m, heading_rad + pan_rad, down_rad, self.params.scaled_focal_px)

    def view(self, camera: Camera, number: int = 0, motion_px: Array | None = None, object_m: Array = ORIGIN_M) -> View:
        """An exposure; equal numbers have equal noise."""
        motion_px = np.zeros(2) if motion_px is None else motion_px
        image = self._painter.image(camera, object_m)
        return View(self._sensor.expose(image, motion_px, np.random.default_rng([1, number])), camera)

    def views(self, count: int, seed: int = 11) -> Iterator[View]:
        """From everywhere, the object near the middle; every third is blurred."""
        rng = np.random.default_rng(seed)
        for number in range(count):
            camera = self.camera(
                rng.uniform(-WIDEST_RAD, WIDEST_RAD),
                rng.uniform(NEAREST_M, FARTHEST_M),
                rng.uniform(-0.1, 0.1),
                rng.uniform(-0.07, 0.07),
            )
            yield self.view(camera, number, rng.uniform(-3, 3, 2) if number % 3 == 0 else None)

    def partial_views(self, count: int, least: float = 0.25, seed: int = 12) -> Iterator[View]:
        """From everywhere, the object anywhere in the image with at least this share of it inside, often cut off."""
        rng = np.random.default_rng(seed)
        number = 0
        while number < count:
            camera = self.camera(
                rng.uniform(-WIDEST_RAD, WIDEST_RAD),
                rng.uniform(NEAREST_M, FARTHEST_M),
                rng.uniform(-0.5, 0.5),
                rng.uniform(-0.4, 0.4),
            )
            if self.share(camera) >= least:
                number += 1
                yield self.view(camera, number, rng.uniform(-3, 3, 2) if number % 3 == 0 else None)

    def empty_views(self, count: int, seed: int = 13) -> Iterator[View]:
        """From everywhere to everywhere; there is no object."""
        rng = np.random.default_rng(seed)
        for number in range(count):
            camera = self.camera(
                rng.uniform(-WIDEST_RAD, WIDEST_RAD),
                rng.uniform(NEAREST_M, FARTHEST_M),
                rng.uniform(-100 * DEG, 100 * DEG) if number % 2 else rng.uniform(-0.5, 0.5),
                rng.uniform(-0.2, 0.3),
            )
            yield self.view(camera, number, rng.uniform(-3, 3, 2) if number % 3 == 0 else None, AWAY_M)

    def share(self, camera: Camera) -> float:
        """How much of the object's outline lies in the image."""
        rings_m, _, _ = scene.mantle(self.params)
        points = camera.project(rings_m.reshape(-1, 3))
        if np.isnan(points).any():
            return 0.0
        outline = cv2.convexHull(points.astype(np.float32))
        half = 0.5 * np.array((self.params.width_px, self.params.height_px))
        frame = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
        inside, _ = cv2.intersectConvexConvex(outline, frame.astype(np.float32))
        return float(inside) / cv2.contourArea(outline)

    def is_object(self, camera: Camera, spot: tuple[float, float, int] | None) -> bool:
        """Whether what was seen at (u, v, pixels) is the object."""
        rings_m, _, _ = scene.mantle(self.params)
        points = camera.project(rings_m.reshape(-1, 3))
        low, high = points.min(axis=0) - SLACK_PX, points.max(axis=0) + SLACK_PX
        return spot is not None and bool(np.all((low <= spot[:2]) & (spot[:2] <= high)))

    def edge(self, camera: Camera, u_px: float, edge: str) -> tuple[float, float]:
        """(row, slope) at which the line that a method looks for crosses column `u_px`, by the projection alone."""
        return line(camera, self.params, u_px, self.params.stripe_z_m if edge == "stripe" else self.params.table_z_m)


def line(camera: Camera, params: Params, u_px: float, z_m: float) -> tuple[float, float]:
    """(row, slope) of a line along the table's front at height `z_m`, where it crosses column `u_px`."""
    along = np.array((0.0, 1.0, 0.0))
    right, _, forward = camera.axes
    plane = camera.focal_px * right - u_px * forward  # u depth = f right: linear in the position along the edge
    point = np.array((-params.edge_offset_m, 0.0, z_m))
    point = point - along * (plane @ (point - camera.position)) / (plane @ along)
    return float(camera.project(point[None])[0, 1]), camera.slope(point, along)


def decoded(data: bytes) -> NDArray[np.uint8]:
    """Pixels `[height, width, 3]` blue, green, red."""
    return np.asarray(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR), np.uint8)
