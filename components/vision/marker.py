"""A square marker as the object: OpenCV's own detector of ArUco markers and AprilTags (Garrido-Jurado et al. 2014)."""

from __future__ import annotations

from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from components.vision.blob import Blob
from components.vision.params import DICTIONARIES

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

BORDER_PX = 1
"""A corner may come so near to the image's border."""
CORRECTED = 0.0
"""No bit that is read wrong is put right: with OpenCV's 0.6 anything square is some marker sooner or later."""


class Marker(NamedTuple):
    """A marker in an image."""

    corners: Array
    """`[4, 2]` column, row; from its own upper left corner on, clockwise."""

    @property
    def middle(self) -> tuple[float, float]:
        """(column, row) of the square's centre: where the diagonals cross, which perspective keeps."""
        first, second, third, fourth = self.corners
        along, across = third - first, fourth - second
        between = second - first
        share = (between[0] * across[1] - between[1] * across[0]) / (along[0] * across[1] - along[1] * across[0])
        column, row = (first + share * along).tolist()
        return column, row

    @property
    def pixels(self) -> int:
        """Area."""
        return round(cv2.contourArea(self.corners.astype(np.float32)))

    @property
    def blob(self) -> Blob:
        """Its pixels, cut out."""
        left, top, width, height = cv2.boundingRect(self.corners.astype(np.float32))
        mask = np.zeros((height, width), np.uint8)
        cv2.fillConvexPoly(mask, np.rint(self.corners - (left, top)).astype(np.int32), (255,))
        return Blob(mask, left, top, cv2.countNonZero(mask))


class Detector:
    """Looks for one marker of one dictionary."""

    def __init__(self, dictionary: str, number: int) -> None:
        self._number = number
        known = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, DICTIONARIES[dictionary].name))
        parameters = cv2.aruco.DetectorParameters()
        parameters.minDistanceToBorder = BORDER_PX
        parameters.errorCorrectionRate = CORRECTED
        parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
        self._detector = cv2.aruco.ArucoDetector(known, parameters)

    def find(self, image: Image) -> Marker | None:
        """The marker in an image `[height, width, 3]`, the largest if there are several."""
        # `numbers` is None if there are none, whatever its annotation says.
        found: tuple[Any, Any, Any] = self._detector.detectMarkers(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY))
        corners, numbers, _ = found
        if numbers is None:
            return None
        wanted = np.asarray(numbers).ravel() == self._number
        markers = [
            Marker(np.asarray(each, np.float64).reshape(4, 2))
            for each, mine in zip(corners, wanted, strict=True)
            if mine
        ]
        return max(markers, key=lambda marker: marker.pixels, default=None)
