"""The band of pixels along a line, which is tilted until the band is the same from end to end.

A border of brightness is told by the peak of the gradient in each column. In one of colour alone, of which a JPEG keeps
half, a single column tells little; but all of them show the same border, under a light that may change along it. So
what changes along the band is put down to a tilt, as far as it is what a shift would change (Lucas and Kanade 1981),
and to the light, as far as it is a share of the band itself.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from components.vision.edge import Line

Array = NDArray[np.float64]
Whole = NDArray[np.intp]
Band = NDArray[np.float32]
"""`[rows, columns, 3]`, the line in the middle row."""
Image = NDArray[np.uint8]

REACH_PX = 3
"""Rows of the band on either side of the line. A stripe of 3 cm is 5 px high from 2 m."""
COLUMNS_MIN = 32
"""Fewer columns tell too little."""
STRANGE = 3.0
"""Columns that differ from the mean by more than so many times what the middle one does are another thing."""
MOST_PX = 2.5
"""What would move an end of the line further was no border."""


class Course(NamedTuple):
    """A line as y over x: rows over columns, or columns over rows if it is steep, so that no slope is above 1."""

    x_px: float
    y_px: float
    slope: float
    steep: bool

    @classmethod
    def of(cls, line: Line) -> Course:
        """That of a line."""
        if abs(line.slope) <= 1.0:
            return cls(line.column_px, line.row_px, line.slope, steep=False)
        return cls(line.row_px, line.column_px, 1.0 / line.slope, steep=True)

    @property
    def line(self) -> Line:
        """As a line; one of columns over rows must not be vertical."""
        return Line(self.y_px, self.x_px, 1.0 / self.slope) if self.steep else Line(self.x_px, self.y_px, self.slope)

    def at(self, x: Whole) -> Array:
        """The line's y there."""
        return np.asarray(self.y_px + self.slope * (x - self.x_px), np.float64)


def straightened(image: Image, line: Line, pixels: Array) -> Line:
    """A line through some of an image's `[height, width, 3]` pixels `[M, 2]` (column, row), tilted about its point."""
    course = Course.of(line)
    found = tilted(image, course, np.unique(pixels[:, int(course.steep)]).astype(np.intp))
    return found.line if found.slope * course.slope > 0.0 or not course.steep else line


def tilted(image: Image, course: Course, x: Whole) -> Course:
    """A line tilted about its point by what is beside it at some `x`, ascending."""
    y = course.at(x)
    inside = x[(y >= REACH_PX) & (y < image.shape[course.steep] - REACH_PX - 1)]
    if len(inside) < COLUMNS_MIN:
        return course
    pixels = along(image, course, (int(inside[0]), int(inside[-1])), REACH_PX)
    return course._replace(slope=course.slope + _tilt(inside, pixels[:, inside - inside[0]]))


def along(image: Image, course: Course, ends: tuple[int, int], reach_px: int) -> Band:
    """What is so far on either side of a line from one x to another, both included."""
    first, last = ends
    start = course.y_px + course.slope * (first - course.x_px) - reach_px
    way = np.array(((1.0, 0.0, first), (course.slope, 1.0, start)))
    size = (last - first + 1, 2 * reach_px + 1)
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    pixels = cv2.warpAffine(
        image, way[::-1] if course.steep else way, size, flags=flags, borderMode=cv2.BORDER_REPLICATE
    )
    return np.asarray(pixels, np.float32)


def _tilt(columns: Whole, band: Band) -> float:
    """How much the slope of a band has to grow whose columns `[N]` are these."""
    away = np.abs(band - band.mean(axis=1, keepdims=True)).sum(axis=(0, 2))
    usual = away <= STRANGE * np.partition(away, len(away) // 2)[len(away) // 2]
    offsets, band = (columns[usual] - columns[usual].mean()).astype(np.float32), band[:, usual]
    profile = band.mean(axis=1)
    change = (offsets @ band[1:-1]).ravel() / (offsets @ offsets)
    shifted, light = 0.5 * (profile[:-2] - profile[2:]).ravel(), profile[1:-1].ravel()
    shifted -= light * (shifted @ light) / max(float(light @ light), 1.0)  # what is left can not be the light
    tilt = float(shifted @ change) / max(float(shifted @ shifted), 1.0)
    return tilt if abs(tilt) * np.abs(offsets).max() <= MOST_PX else 0.0
