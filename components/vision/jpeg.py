"""Decodes a JPEG that may be hostile: its header is read before any memory is spent on it."""

from __future__ import annotations

import re

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]

BYTES_MAX = 4_000_000
"""Larger messages are refused unread."""
SEGMENTS_MAX = 64
"""Segments before the scan; a camera writes about ten."""
BASELINE = frozenset({0xC0, 0xC1})
"""Frame markers that are decoded. Progressive images are not: a small one can ask for minutes of work."""
FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
SCAN = 0xDA
STRAY_MARKER = re.compile(rb"\xff[^\x00\xd0-\xd7\xd9\xff]")
"""What can not stand in the data of the only scan of a baseline image (ITU T.81, B.1.1.5)."""
TAIL_ROWS = 8
"""Height of the last row of blocks."""


class JpegError(Exception):
    """Why an image could not be used, in words for a person."""


def decode(data: bytes, width_px: int, height_px: int) -> Image:
    """Pixels `[height, width, 3]` blue, green, red.

    Raises:
        JpegError: not a baseline colour JPEG of that size, damaged, or blank.
    """
    found = size(data)
    if found != (width_px, height_px):
        raise JpegError(f"the image is {found[0]}x{found[1]} px; expected {width_px}x{height_px}")
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    except cv2.error as error:
        raise JpegError("the JPEG can not be decoded") from error
    if image is None:
        raise JpegError("the JPEG is damaged or cut short")
    # libjpeg fills what is missing with one colour and says so on standard error only.
    if _one_colour(image[-1:]) and _one_colour(image[-TAIL_ROWS:]):
        raise JpegError("the last rows are of one colour: a damaged or an empty image")
    return np.asarray(image, np.uint8)


def _one_colour(rows: cv2.typing.MatLike) -> bool:
    return bool((rows == rows[0, 0]).all())


def size(data: bytes) -> tuple[int, int]:
    """(width, height) that the header of a baseline colour JPEG announces.

    Raises:
        JpegError: it is none.
    """
    if len(data) > BYTES_MAX:
        raise JpegError(f"the image has {len(data)} bytes; at most {BYTES_MAX} are read")
    if data[:2] != b"\xff\xd8":
        raise JpegError("the image is not a JPEG")
    found, at = None, 2
    for _ in range(SEGMENTS_MAX):
        marker, length = _segment(data, at)
        if marker in FRAMES:
            if found is not None:
                raise JpegError("the JPEG has two frame headers")
            found = _frame(data, at, marker)
        at += 2 + length
        if marker == SCAN:
            break
    else:
        raise JpegError("the JPEG has no scan")
    if found is None:
        raise JpegError("the JPEG has no frame header")
    if STRAY_MARKER.search(data, at):
        raise JpegError("the JPEG is damaged: a marker inside the scan")
    return found


def _segment(data: bytes, at: int) -> tuple[int, int]:
    """(marker, length) of the segment at a position."""
    if at + 4 > len(data) or data[at] != 0xFF:
        raise JpegError("the JPEG header is cut short or damaged")
    length = int.from_bytes(data[at + 2 : at + 4], "big")
    if length < 2 or at + 2 + length > len(data):
        raise JpegError("the JPEG header is cut short or damaged")
    return data[at + 1], length


def _frame(data: bytes, at: int, marker: int) -> tuple[int, int]:
    if marker not in BASELINE:
        raise JpegError("the JPEG is not a baseline one")
    if at + 10 > len(data) or data[at + 9] != 3:
        raise JpegError("the JPEG is not in colour")
    return int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")
