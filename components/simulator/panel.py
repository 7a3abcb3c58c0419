"""A square marker on a white panel that stands upright on the table, through the object's centre."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from components.simulator.params import Params
from docking.pinhole import Array, Camera

Image = NDArray[np.uint8]

CELL_PX = 16
"""Of the picture that is warped."""
FINER = 4
"""Drawn so many times finer than the image, then averaged: antialiasing."""
MARGIN_PX = 2
BLACK, WHITE = 28.0, 225.0
MARKERS = cv2.aruco.DICT_4X4_50
BITS = 4


class Panel:
    """Drawn into images."""

    def __init__(self, params: Params, gains: tuple[float, ...]) -> None:
        """Paint it.

        Args:
            params: size, number, table.
            gains: of the lamp, blue, green, red.
        """
        cells = BITS + 2
        code = cv2.aruco.generateImageMarker(
            cv2.aruco.getPredefinedDictionary(MARKERS), params.marker_id, cells * CELL_PX
        )
        half_m = 0.5 * params.marker_m
        cell_m = params.marker_m / cells
        top_m, bottom_m, side_m = half_m + cell_m, -0.5 * params.object_height_m, half_m + cell_m
        below_px = max(0, round((-half_m - bottom_m) / cell_m * CELL_PX))
        framed = cv2.copyMakeBorder(code, CELL_PX, below_px, CELL_PX, CELL_PX, cv2.BORDER_CONSTANT, value=(255,))
        grey = BLACK + (WHITE - BLACK) / 255.0 * framed.astype(np.float64)
        self._picture = np.minimum(grey[..., None] * np.array(gains), 255.0).astype(np.float32)
        bottom_m = -half_m - below_px * cell_m / CELL_PX
        self._corners_m = np.array(
            [(0, side_m, top_m), (0, -side_m, top_m), (0, -side_m, bottom_m), (0, side_m, bottom_m)]
        )

    def draw(self, image: Image, camera: Camera, object_m: Array) -> None:
        """Draw its front, which looks at the robot's side; from behind nothing is seen."""
        corners = camera.project(self._corners_m + object_m)
        if np.isnan(corners).any() or camera.position[0] >= object_m[0]:
            return
        height, width = image.shape[:2]
        corners = corners + 0.5 * np.array((width - 1, height - 1))
        low = np.clip(np.floor(corners.min(axis=0)).astype(int) - MARGIN_PX, 0, (width, height))
        high = np.clip(np.ceil(corners.max(axis=0)).astype(int) + MARGIN_PX, 0, (width, height))
        if (high - low < 1).any():
            return
        window = image[low[1] : high[1], low[0] : high[0]]
        paint, share = self._warped(corners - low, window.shape)
        window[:] = np.rint(window * (1.0 - share) + paint).astype(np.uint8)

    def _warped(self, corners: Array, shape: tuple[int, ...]) -> tuple[Array, Array]:
        """(paint times share, share of each pixel that it covers)."""
        rows, columns, _ = self._picture.shape
        # A pixel's centre has whole numbers, in the picture and in the finer image.
        own = np.array([(0, 0), (columns, 0), (columns, rows), (0, rows)]) - 0.5
        finer = (corners + 0.5) * FINER - 0.5
        warp = cv2.getPerspectiveTransform(own.astype(np.float32), finer.astype(np.float32))
        size = shape[1] * FINER, shape[0] * FINER
        paint = cv2.warpPerspective(self._picture, warp, size, flags=cv2.INTER_LINEAR)
        share = cv2.warpPerspective(np.ones((rows, columns), np.float32), warp, size, flags=cv2.INTER_LINEAR)
        small = shape[1], shape[0]
        paint, share = (cv2.resize(each, small, interpolation=cv2.INTER_AREA) for each in (paint, share))
        return np.asarray(paint, np.float64), np.asarray(share, np.float64)[..., None]
