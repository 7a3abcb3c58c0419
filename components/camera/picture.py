"""Any picture as a JPEG of one size, byte for byte as it is where it can stay. Pictures come from strangers."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from components.camera.header import PictureError, Size, announced, is_baseline

Image = NDArray[np.uint8]
BYTES_MAX = 48_000_000
"""Of a file; more is not read."""
_QUALITY = 95
_STEP_PX = 8
_SHAPE_SHARE = 0.01
"""Two shapes are the same if their sides differ by less than this share."""


def as_jpeg(data: bytes, size: Size) -> bytes:
    """JPEG of a size.

    Raises:
        PictureError: no picture, damaged, or of another shape.
    """
    found = announced(data)
    if found == size and is_baseline(data):
        return data
    check_shape(found, size)
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    except cv2.error:
        image = None
    if image is None or image.shape[1::-1] != found:
        raise PictureError("damaged")
    return encoded(scaled(np.asarray(image, np.uint8), size))


def check_shape(found: Size, size: Size) -> None:
    """Refuse to stretch.

    Raises:
        PictureError: another shape; the message names a size that would do.
    """
    if not is_alike(found, size):
        width, height = alike(found)
        raise PictureError(
            f"is {found[0]}x{found[1]} px; width_px and height_px must be as its shape, {width}x{height}"
        )


def alike(found: Size) -> Size:
    """A size from 320 px up, sides multiples of 8, that has the same shape, exactly if there is one."""
    for share in (0.0, _SHAPE_SHARE):
        for width in range(320, 1921, _STEP_PX):
            size = width, max(_STEP_PX, round(width * found[1] / found[0] / _STEP_PX) * _STEP_PX)
            if is_alike(found, size, share):
                return size
    return 320, 240


def is_alike(found: Size, size: Size, share: float = _SHAPE_SHARE) -> bool:
    """Whether two sizes have one shape."""
    stretch = size[0] * found[1] / (found[0] * size[1])
    return abs(stretch - 1.0) <= share


def scaled(image: Image, size: Size) -> Image:
    """`[height, width, 3]` of this size."""
    if image.shape[1::-1] == size:
        return image
    smaller = image.shape[1] > size[0]
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA if smaller else cv2.INTER_LINEAR), np.uint8)


def encoded(image: Image) -> bytes:
    """As a baseline JPEG.

    Raises:
        PictureError: it can not be encoded.
    """
    done, data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, _QUALITY])
    if not done:
        raise PictureError("can not be encoded")
    return bytes(data.tobytes())
