"""What a JPEG's or PNG's header announces, read before any memory is spent on the image."""

from __future__ import annotations

Size = tuple[int, int]
"""(width, height), px."""
LARGEST_PX = 8192
"""Of either side; more is absurd."""
SEGMENTS_MAX = 64
"""Segments before a JPEG's scan; a camera writes about ten."""
BASELINE = frozenset({0xC0, 0xC1})
_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_SCANS_MAX = 16
"""Of a progressive JPEG: a small one with thousands asks for minutes of work."""
_PNG = b"\x89PNG\r\n\x1a\n"


class PictureError(Exception):
    """Why a picture can not be used, in words for a person."""


def announced(data: bytes) -> Size:
    """(width, height) that a JPEG's or PNG's header announces.

    Raises:
        PictureError: neither of them, or absurd.
    """
    if data[: len(_PNG)] == _PNG and len(data) >= 24:
        width, height = int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
    elif data[:2] == b"\xff\xd8":
        width, height = _frame(data)[1]
    else:
        raise PictureError("neither JPEG nor PNG")
    check(width, height)
    return width, height


def check(width: int, height: int) -> None:
    """Refuse absurd sizes.

    Raises:
        PictureError: it is one.
    """
    if not (0 < width <= LARGEST_PX and 0 < height <= LARGEST_PX):
        raise PictureError(f"an absurd size; at most {LARGEST_PX} px a side")


def is_baseline(data: bytes) -> bool:
    """Whether it is a baseline JPEG in colour, which is all that the eyes take.

    Raises:
        PictureError: a broken header.
    """
    if data[:2] != b"\xff\xd8":
        return False
    marker, _, components = _frame(data)
    return marker in BASELINE and components == 3


def _frame(data: bytes) -> tuple[int, Size, int]:
    """(marker, size, components) of a JPEG's frame. A thumbnail, with a frame of its own, lies within a segment."""
    at = 2
    for _ in range(SEGMENTS_MAX):
        while data[at : at + 2] == b"\xff\xff":  # fill
            at += 1
        if len(data) < at + 10 or data[at] != 0xFF or data.count(b"\xff\xda") > _SCANS_MAX:
            break
        if data[at + 1] in _FRAMES:
            size = int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")
            return data[at + 1], size, data[at + 9]
        at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    raise PictureError("a JPEG without a usable header")
