"""The table's edge without a stripe: the first long straight line below the object, by Hough's transform.

Canny's edge pixels of all three colours vote for lines (Duda and Hart 1972). The object stands on the table, so that
the edge crosses its column below it, and nothing between the two is as long: of the lines there, the uppermost of those
about as long as the longest is it; the others are the front's lower border, a rug, the floor. Each line is fitted to
its pixels, moved along their columns to where the gradient peaks, and the edge's tilt is then told by all the pixels
beside it (`band.py`). Without an object nothing tells the edge from others.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from components.vision import band
from components.vision.blob import Blob
from components.vision.edge import Line

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

WEAK, STRONG = 40.0, 80.0
"""Canny's two thresholds. A step of 20 grey levels has a gradient of 80. Tuned in simulation."""
BRIGHT_GREY = 100.0
"""In images whose brightest colour is darker on the mean the thresholds fall with it."""
RHO_PX, THETA_RAD = 2.0, np.pi / 180.0
"""Cells that are voted for."""
STEEPEST_RAD = np.deg2rad(80.0)
"""Steeper lines are not voted for."""
VOTES_SHARE = 0.5
"""A line needs this share of `edge_length_min_px` in one cell: its pixels are spread over a few."""
BEST_SHARE = 0.3
"""And this share of the votes of the best line below the object."""
BELOW_PX = 3.0
"""The edge may cross the object's column so far above its lower end, which pixels hide."""
SAME_RAD, SAME_PX = 3.0 * THETA_RAD, 4.0
"""Candidates as alike as this are the same line."""
CANDIDATES = 8
"""That are looked at closely."""
REACHES_PX = (3.0, 3.0, 2.0, 1.5)
"""Pixels further than this from the line are left out of the first, the second, ... the last fit."""
TIGHT_PX = 0.75
"""A line's pixels are those nearer than this to the last fit: all of a table's, a third of those in fur or leaves."""
LENGTH_SHARE = 0.6
"""A line with fewer than this share of the longest one's pixels is not the edge."""
DENSE_MIN = 0.5
"""Nor is one with smaller shares of its columns (rows) marked, such as a row of things."""
MARGIN_PX = 2
"""Around the object, where its own outline is."""
GAP_SHARE = 0.15
"""The edge's pixels come so near to the object's column, in widths of the image; the object hides no more of it."""
VERTICAL = 0.1
"""Smaller slopes of rows are no edge: nobody stands so far aside."""


class Edge(NamedTuple):
    """A line and what it was fitted to."""

    line: Line
    pixels: Array
    """`[M, 2]` column, row."""


def edge(image: Image, thing: Blob, column_px: float, length_min_px: float) -> Edge | None:
    """The table's edge in an image `[height, width, 3]`.

    Args:
        image: blue, green, red.
        thing: the object.
        column_px: the object's column.
        length_min_px: of fewer pixels no edge is made.
    """
    smooth = cv2.GaussianBlur(image, (3, 3), 0.0)
    light = min(1.0, max(cv2.mean(smooth)[:3]) / BRIGHT_GREY)
    marks = cv2.Canny(smooth, light * WEAK, light * STRONG)
    _forget(marks, thing)
    voted = _voted(marks, round(VOTES_SHARE * length_min_px))
    if not len(voted):
        return None
    points = np.stack(np.divmod(np.flatnonzero(np.asarray(marks) != 0), image.shape[1])[::-1]).astype(np.float64)
    foot_px = thing.top_px + len(thing.mask) - 1 - BELOW_PX
    found = _first(voted, _Marks(np.asarray(smooth, np.uint8), points), (column_px, foot_px), length_min_px)
    return found and found._replace(line=band.straightened(image, found.line, found.pixels))


def _voted(marks: cv2.typing.MatLike, votes_min: int) -> Array:
    """Lines `[K, 3]` (rho, theta, votes), those with the most votes first."""
    least, most = 0.5 * np.pi - STEEPEST_RAD, 0.5 * np.pi + STEEPEST_RAD
    found: Any = cv2.HoughLinesWithAccumulator(
        marks, RHO_PX, THETA_RAD, votes_min, min_theta=least, max_theta=most
    )  # None if there are none, whatever its annotation says
    return np.zeros((0, 3)) if found is None else np.asarray(found, np.float64).reshape(-1, 3)


def _forget(marks: cv2.typing.MatLike, thing: Blob) -> None:
    """The object's own outline is no edge of a table."""
    rows, columns = thing.mask.shape
    left, top = max(0, thing.left_px - MARGIN_PX), max(0, thing.top_px - MARGIN_PX)
    marks[top : thing.top_px + rows, left : thing.left_px + columns + MARGIN_PX] = 0


class _Marks(NamedTuple):
    """Edge pixels."""

    image: Image
    points: Array
    """`[2, N]` columns, rows."""


def _first(voted: Array, marks: _Marks, foot: tuple[float, float], length_min_px: float) -> Edge | None:
    """The uppermost of the long lines among those voted for `[K, 3]` (rho, theta, votes), the longest first."""
    rho, theta, votes = voted.T
    rows = (rho - foot[0] * np.cos(theta)) / np.sin(theta)
    below = rows > foot[1]
    below &= votes >= BEST_SHARE * votes[below].max(initial=0.0)
    candidates = np.column_stack((rows, theta))[below]
    found: list[tuple[float, Edge]] = []
    for _ in range(CANDIDATES):
        if not len(candidates):
            break
        row, angle = candidates[0]
        near = _fitted(marks, Line(foot[0], row, -1.0 / np.tan(angle)))
        if near is None or len(near.pixels) < length_min_px:
            candidates = candidates[1:]  # one that lies across two borders; those beside it may be either
            continue
        alike = (np.abs(candidates[:, 0] - row) < SAME_PX) & (np.abs(candidates[:, 1] - angle) < SAME_RAD)
        candidates = candidates[~alike]
        crossing = near.line.row_at(foot[0])
        if crossing > foot[1] and _passes(near, foot[0], marks.image):
            found.append((crossing, near))
            candidates = candidates[candidates[:, 0] < crossing]
    longest = max((len(near.pixels) for _, near in found), default=0)
    long = [each for each in found if len(each[1].pixels) >= LENGTH_SHARE * longest]
    return min(long, key=lambda each: each[0])[1] if long else None


def _fitted(marks: _Marks, line: Line) -> Edge | None:
    """The line through the edge pixels near a line; None if they are none."""
    if abs(line.slope) <= 1.0:
        fit = _through(marks, (line.column_px, line.row_px, line.slope), steep=False)
        return fit and Edge(Line(*fit[0]), fit[1].T)
    fit = _through(marks, (line.row_px, line.column_px, 1.0 / line.slope), steep=True)
    if fit is None or abs(fit[0][2]) < VERTICAL:
        return None
    (row, column, slope), pixels = fit
    return Edge(Line(column, row, 1.0 / slope), pixels[::-1].T)


def _passes(near: Edge, column_px: float, image: Image) -> bool:
    """Whether the pixels come near to where the line crosses the object's column, or to where it enters the image."""
    row_px = near.line.row_at(column_px)
    held_px = min(max(row_px, 0.0), len(image) - 1.0)
    if held_px != row_px:
        column_px += (held_px - row_px) / near.line.slope
    gaps_px = np.abs(near.pixels - (column_px, held_px)).max(axis=1)
    return bool(gaps_px.min() <= GAP_SHARE * image.shape[1])


def _through(
    marks: _Marks, line: tuple[float, float, float], *, steep: bool
) -> tuple[tuple[float, float, float], Array] | None:
    """((mean x, mean y, slope), pixels `[2, M]`) of the regression of y on x, for a line that rises slowly.

    y is the row and x the column, the other way round if it is steep.
    """
    points = marks.points[::-1] if steep else marks.points
    x, y, slope = line
    whole = near = points
    for number, reach_px in enumerate(REACHES_PX):
        if number == 1:
            whole = near = points  # those that the first guess missed come back
        away = np.flatnonzero(np.abs(near[1] - near[0] * slope - (y - slope * x)) <= reach_px * math.hypot(1.0, slope))
        if len(away) < 2:
            return None
        whole = whole.take(away, axis=1)
        near = _peaks(marks.image, whole, steep=steep) if number == 1 else near.take(away, axis=1)
        x, y = near.sum(axis=1) / len(away)
        offsets = near[0] - x
        spread = float(offsets @ offsets)
        if spread == 0.0:
            return None
        slope = float(offsets @ (near[1] - y)) / spread
    whole = whole[:, np.abs(near[1] - y - slope * offsets) <= TIGHT_PX * math.hypot(1.0, slope)]
    columns = np.unique(whole[0])
    if len(columns) == 0 or len(columns) < DENSE_MIN * (columns[-1] - columns[0] + 1.0):
        return None
    return (float(x), float(y), slope), whole


def _peaks(image: Image, points: Array, *, steep: bool) -> Array:
    """Edge pixels `[2, M]` (x, y) moved along y to the vertex of the parabola through the gradient there and beside."""
    x, y = points.astype(np.intp)
    width = image.shape[1]
    onward, aside = (1, width) if steep else (width, 1)  # of pixels in a row, to the next y and to the next x
    here = np.clip(y, 2, image.shape[steep] - 3) * onward + x * aside
    colours = image.reshape(-1, 3).take(here + onward * np.arange(-2, 3)[:, None], axis=0).astype(np.int16)
    changes = np.abs(colours[2:] - colours[:-2])
    before, peak, after = changes[..., 0] + changes[..., 1] + changes[..., 2]
    bend = before - 2 * peak + after
    shift = np.where(bend < 0, 0.5 * (before - after) / np.where(bend < 0, bend, 1), 0.0)
    return np.stack((points[0], points[1] + np.clip(shift, -1.0, 1.0)))
