"""The camera's imperfections: falloff of light, motion blur, noise, JPEG."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from components.simulator.params import Params
from docking.pinhole import Array

Image = NDArray[np.uint8]

SHARP_PX = 0.3
"""Motion below this is not blurred."""
BLUR_LIMIT_PX = 24.0
"""Longest blur: beyond it nothing is recognised anyway."""
UNIT_GAIN = 128
"""Gain of the light map that leaves a pixel as it is."""
NOISE_STREAM = 1
"""Tag of the generator of the noise field, apart from the frames' own."""


class Sensor:
    """From a clean image to the bytes that a camera delivers."""

    def __init__(self, params: Params, seed: int) -> None:
        self._params = params
        shape = (params.height_px, params.width_px, 3)
        self._gain = _gain(shape, params.light_falloff)
        self._more, self._less = _noise(shape, params.noise_grey, seed)

    def expose(self, image: Image, motion_px: Array, generator: np.random.Generator) -> bytes:
        """JPEG of one exposure.

        Args:
            image: `[height, width, 3]`.
            motion_px: way of the image during the exposure, (u, v).
            generator: of this frame; picks the window of the noise field.
        """
        image = np.asarray(cv2.multiply(image, self._gain, scale=1.0 / UNIT_GAIN), np.uint8)
        image = self._grain(blurred(image, motion_px), generator)
        done, data = cv2.imencode(".jpg", image, (cv2.IMWRITE_JPEG_QUALITY, self._params.jpeg_quality))
        if not done:  # pragma: no cover - OpenCV has no reason to
            raise ValueError("OpenCV could not encode an image")
        return data.tobytes()

    def _grain(self, image: Image, generator: np.random.Generator) -> Image:
        """Add noise: a window at random in a field four times the image, because drawing anew costs 0.6 ms."""
        if self._params.noise_grey == 0.0:
            return image
        height, width = image.shape[:2]
        top, left = (int(offset) for offset in generator.integers(0, (height + 1, width + 1)))
        window = np.s_[top : top + height, left : left + width]
        return np.asarray(cv2.subtract(cv2.add(image, self._more[window]), self._less[window]), np.uint8)


def blurred(image: Image, motion_px: Array) -> Image:
    """The image smeared along both axes over its motion, centred on the middle of the exposure."""
    across, down = (min(abs(float(way)), BLUR_LIMIT_PX) for way in motion_px)
    if max(across, down) < SHARP_PX:
        return image
    return np.asarray(cv2.sepFilter2D(image, -1, _box(across), _box(down), borderType=cv2.BORDER_REPLICATE), np.uint8)


def _box(length_px: float) -> Array:
    """A box filter of a length that need not be a whole number, `[odd]`, sum 1."""
    half = max(0.5, 0.5 * length_px)
    reach = math.ceil(half - 0.5)
    offsets = np.abs(np.arange(-reach, reach + 1))
    weights = np.clip(half + 0.5 - offsets, 0.0, 1.0)
    return np.asarray(weights / weights.sum())


def _gain(shape: tuple[int, int, int], falloff: float) -> Image:
    """Light falls linearly from the upper left to the lower right corner."""
    height, width, _ = shape
    way = (np.arange(height)[:, None] / height + np.arange(width)[None] / width) / 2.0
    gain = np.rint(UNIT_GAIN * (1.0 - falloff * way)).astype(np.uint8)
    return np.ascontiguousarray(np.repeat(gain[:, :, None], 3, axis=2))


def _noise(shape: tuple[int, int, int], deviation: float, seed: int) -> tuple[Image, Image]:
    """Fields twice as high and wide as the image: what is added and what is taken away."""
    height, width, colours = shape
    field = np.random.default_rng([seed, 0, NOISE_STREAM]).normal(0.0, deviation, (2 * height, 2 * width, colours))
    field = np.rint(field)
    return np.clip(field, 0, 255).astype(np.uint8), np.clip(-field, 0, 255).astype(np.uint8)
