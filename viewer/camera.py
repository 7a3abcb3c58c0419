"""The camera image, and what vision found in it, drawn over that very image."""

from __future__ import annotations

import math

from components.vision.jpeg import JpegError, size
from report.pairs import Pairs
from schemas.image_pb2 import CompressedImage
from schemas.view_pb2 import View
from viewer.rate import Rate
from viewer.shown import Lines, Picture, Point, Shown, What

OBJECT, EDGE, CENTRE = (64, 255, 128, 255), (255, 140, 0, 255), (255, 255, 255, 160)
_ARM_PX = 8.0
_CORNERS = 24


class Camera:
    """Shows images at a bounded rate; what was found is shown with its image alone, so that nothing swims."""

    def __init__(self, period_ns: int) -> None:
        """At most one image a period."""
        self._rate = Rate(period_ns)
        self._pairs: Pairs[tuple[int, int], View] = Pairs()
        """Width and height of an image that is shown, and what was found in it; either may be heard first."""

    def image(self, message: CompressedImage, capture_ns: int, now_ns: int) -> list[Shown]:
        """One image; nothing if it comes too soon or is none that vision would look at."""
        if not self._rate.passes(now_ns):
            return []
        try:
            pair = self._pairs.first(capture_ns, size(message.data))
        except JpegError:
            return []
        return [Shown("camera/image", capture_ns, Picture(message.data, "jpeg")), *_drawn(pair, capture_ns)]

    def view(self, message: View, capture_ns: int) -> list[Shown]:
        """What was found in an image that is shown."""
        return _drawn(self._pairs.second(capture_ns, message), capture_ns)


def _drawn(pair: tuple[tuple[int, int], View] | None, capture_ns: int) -> list[Shown]:
    if pair is None:
        return []
    (width, height), view = pair
    marks: dict[str, What] = {
        "object": Lines(_object(view, width, height), OBJECT, 2.0),
        "edge": Lines(_edge(view, width, height), EDGE, 2.0),
        "centre": Lines(_cross(width / 2, height / 2), CENTRE, 1.0),
    }
    return [Shown(f"camera/image/{name}", capture_ns, what) for name, what in marks.items()]


def _object(view: View, width: int, height: int) -> tuple[tuple[Point, ...], ...]:
    """A ring about the object's centre, a little wider than a disc of as many pixels as the object has."""
    column, row = view.object_u_px + width / 2, view.object_v_px + height / 2
    if not (view.object_visible and math.isfinite(column) and math.isfinite(row)):
        return ()
    radius = 4.0 + math.sqrt(min(view.object_pixels, 1_000_000) / math.pi)
    turns = [2 * math.pi * corner / _CORNERS for corner in range(_CORNERS + 1)]
    return (tuple((column + radius * math.cos(turn), row + radius * math.sin(turn)) for turn in turns),)


def _edge(view: View, width: int, height: int) -> tuple[tuple[Point, ...], ...]:
    """The table's edge across the image. It is given by its slope and its row at the object's column."""
    if not (view.edge_visible and math.isfinite(view.edge_slope) and math.isfinite(view.edge_v_px)):
        return ()
    column = view.object_u_px + width / 2 if view.object_visible else width / 2
    row, slope = view.edge_v_px + height / 2, view.edge_slope
    left, right = 0.0, float(width)
    if slope != 0.0:  # as far as it is in the image, or the viewer would make room for the rest
        top, bottom = sorted((column - row / slope, column + (height - row) / slope))
        left, right = max(left, top), min(right, bottom)
    elif not 0.0 <= row <= height:
        return ()
    if not left < right:
        return ()
    return (((left, row + slope * (left - column)), (right, row + slope * (right - column))),)


def _cross(column: float, row: float) -> tuple[tuple[Point, ...], ...]:
    return (
        ((column - _ARM_PX, row), (column + _ARM_PX, row)),
        ((column, row - _ARM_PX), (column, row + _ARM_PX)),
    )
