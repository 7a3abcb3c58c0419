"""A picture of whatever kind as the baseline JPEG that the eyes take. Pictures come from strangers."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from components.camera.header import PictureError, Size, announced, check
from components.vision import jpeg

__all__ = ["PictureError", "Raw", "Size", "announced", "as_jpeg", "fitting"]

Pixels = NDArray[np.uint8]
BYTES_MAX = 48_000_000
_QUALITY = 95
_EYES_MAX: Size = (1920, 1440)
_EYES_MIN: Size = (64, 48)
_STEP_PX = 8
_RAW: dict[str, tuple[int, int | None]] = {
    "bgr8": (3, None),
    "rgb8": (3, cv2.COLOR_RGB2BGR),
    "bgra8": (4, cv2.COLOR_BGRA2BGR),
    "rgba8": (4, cv2.COLOR_RGBA2BGR),
    "8UC3": (3, None),
    "mono8": (1, cv2.COLOR_GRAY2BGR),
    "8UC1": (1, cv2.COLOR_GRAY2BGR),
    "yuv422": (2, cv2.COLOR_YUV2BGR_UYVY),
    "uyvy": (2, cv2.COLOR_YUV2BGR_UYVY),
    "yuv422_yuy2": (2, cv2.COLOR_YUV2BGR_YUY2),
    "yuyv": (2, cv2.COLOR_YUV2BGR_YUY2),
    "bayer_rggb8": (1, cv2.COLOR_BayerBG2BGR),
    "bayer_bggr8": (1, cv2.COLOR_BayerRG2BGR),
    "bayer_gbrg8": (1, cv2.COLOR_BayerGR2BGR),
    "bayer_grbg8": (1, cv2.COLOR_BayerGB2BGR),
}
"""ROS's encoding -> (bytes per pixel, OpenCV's conversion, whose Bayer names are those of the second row)."""


class Raw(NamedTuple):
    """An uncompressed picture as sensor_msgs/Image has it."""

    width: int
    height: int
    encoding: str
    step: int
    data: bytes


def as_jpeg(data: bytes | Raw) -> tuple[Size, bytes]:
    """(size, baseline JPEG) of a size that the eyes take.

    What they take as it is stays as it is, byte for byte. Larger pictures are scaled down by a whole number; what is
    left over to a multiple of 8 px is cut off at the right and below.

    Raises:
        PictureError: not a picture of a kind that is known, damaged, too small, or absurdly large.
    """
    if isinstance(data, Raw):
        return _encoded(_fitted(_pixels(data)))
    if len(data) > BYTES_MAX:
        raise PictureError("too many bytes")
    size = announced(data)
    if fitting(size) == (1, size):
        try:
            jpeg.decode(data, *size)
        except jpeg.JpegError:
            pass
        else:
            return size, data
    return _encoded(_fitted(_decoded(data)))


def fitting(size: Size) -> tuple[int, Size]:
    """(whole number to scale down by, size that the eyes take).

    Raises:
        PictureError: too small.
    """
    down = max(1, *(-(-side // most) for side, most in zip(size, _EYES_MAX, strict=True)))
    width, height = (side // down // _STEP_PX * _STEP_PX for side in size)
    if width < _EYES_MIN[0] or height < _EYES_MIN[1]:
        raise PictureError(f"smaller than {_EYES_MIN[0]}x{_EYES_MIN[1]} px")
    return down, (width, height)


def _pixels(raw: Raw) -> Pixels:
    check(raw.width, raw.height)
    known = _RAW.get(raw.encoding)
    if known is None:
        raise PictureError(f"unknown encoding {raw.encoding[:20]!r}")
    depth, conversion = known
    if raw.step < raw.width * depth or raw.step * raw.height != len(raw.data):
        raise PictureError("data that does not fit its size")
    rows = np.frombuffer(raw.data, np.uint8).reshape(raw.height, raw.step)[:, : raw.width * depth]
    if depth == 2 and raw.width % 2:
        raise PictureError("an odd width that its encoding can not have")
    image = rows.reshape(raw.height, raw.width, depth) if depth > 1 else rows
    return np.ascontiguousarray(image if conversion is None else cv2.cvtColor(np.ascontiguousarray(image), conversion))


def _decoded(data: bytes) -> Pixels:
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    except cv2.error:
        image = None
    if image is None or image.shape[1::-1] != announced(data):
        raise PictureError("damaged")
    return np.asarray(image, np.uint8)


def _fitted(image: Pixels) -> Pixels:
    down, (width, height) = fitting((image.shape[1], image.shape[0]))
    if down > 1:
        small = (image.shape[1] // down, image.shape[0] // down)
        image = np.asarray(cv2.resize(image, small, interpolation=cv2.INTER_AREA), np.uint8)
    return np.ascontiguousarray(image[:height, :width])


def _encoded(image: Pixels) -> tuple[Size, bytes]:
    done, data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, _QUALITY])
    if not done:
        raise PictureError("can not be encoded")
    return (image.shape[1], image.shape[0]), data.tobytes()
