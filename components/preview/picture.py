"""A JPEG again, in fewer bytes. It may be hostile: its header is read before any memory is spent on it."""

from __future__ import annotations

import cv2
import numpy as np

BYTES_MAX = 4_000_000
"""Larger pictures are refused unread."""
PIXELS_MAX = 1920 * 1440
"""What a camera of ours makes at most."""
_SEGMENTS_MAX = 64
_BASELINE = frozenset({0xC0, 0xC1})
"""Frame markers that are decoded: a small progressive picture can ask for minutes of work."""


class PictureError(Exception):
    """Why a picture can not be made smaller, in words for a person."""


def smaller(jpeg: bytes, quality: int) -> bytes:
    """The same picture, of the same size in pixels, at a lower quality; as it is if that saves nothing.

    Args:
        jpeg: baseline JPEG.
        quality: of JPEG, 1 to 100.

    Raises:
        PictureError: no baseline JPEG, too large, or damaged.
    """
    if len(jpeg) > BYTES_MAX or pixels(jpeg) > PIXELS_MAX:
        raise PictureError(f"a picture must have at most {BYTES_MAX} bytes and {PIXELS_MAX} pixels")
    try:
        image = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    except cv2.error:
        image = None
    if image is None:
        raise PictureError("the picture is damaged")
    done, data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])
    if not done:
        raise PictureError("the picture can not be encoded")
    return min(jpeg, bytes(data.tobytes()), key=len)


def pixels(jpeg: bytes) -> int:
    """Width times height that the header of a baseline JPEG announces.

    Raises:
        PictureError: it is none.
    """
    at = 2
    for _ in range(_SEGMENTS_MAX):
        if jpeg[:2] != b"\xff\xd8" or len(jpeg) < at + 9 or jpeg[at] != 0xFF:
            break
        if jpeg[at + 1] in _BASELINE:
            return int.from_bytes(jpeg[at + 5 : at + 7], "big") * int.from_bytes(jpeg[at + 7 : at + 9], "big")
        at += 2 + int.from_bytes(jpeg[at + 2 : at + 4], "big")
    raise PictureError("the picture is no baseline JPEG")
