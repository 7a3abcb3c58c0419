"""RGB thresholds: which pixels are object and which are stripe (Martinez-Marin and Duckett 2005, section V).

Differences between the colours instead of boxes, so that a shadow changes the answer less.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from components.vision.params import Params

Image = NDArray[np.uint8]
Mask = NDArray[np.uint8]


class Thresholds:
    """Judges one image after the other; keeps its working memory, whose allocation would cost more than the work."""

    def __init__(self, params: Params) -> None:
        self._params = params
        self._planes = [np.empty((params.height_px, params.width_px), np.uint8) for _ in range(3)]
        self._none = np.zeros((params.height_px, params.width_px), np.uint8)

    def masks(self, image: Image) -> tuple[Mask, Mask]:
        """(object, stripe), each `[height, width]`, 255 where the colour fits, else 0; no stripe is seen by lines."""
        blue, green, red = cv2.split(image, self._planes)
        greener = _at_least(cv2.subtract(green, cv2.max(red, blue)), self._params.green_over_others)
        if self._params.edge != "stripe":
            return greener, self._none
        redder = _at_least(cv2.subtract(red, green), self._params.red_over_green)
        yellower = _at_least(cv2.subtract(green, blue), self._params.green_over_blue)
        return greener, np.asarray(cv2.bitwise_and(redder, yellower), np.uint8)


def _at_least(values: cv2.typing.MatLike, least: int) -> Mask:
    return np.asarray(cv2.threshold(values, least - 1, 255, cv2.THRESH_BINARY)[1], np.uint8)
