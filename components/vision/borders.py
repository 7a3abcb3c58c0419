"""The two borders of a stripe whose colour is known, near a rough line.

Where it is dark and warm or overexposed, what lies beside a stripe may be taken for it, or parts of it may not. Its
borders are still where the image changes most to its colour and from it. A band along the rough line is cut into
stretches, whose columns are averaged; lines through any two rows at the band's ends are voted for by the change along
them (Hough's transform with the ends as parameters). The best of each kind is then tilted as any border is (`band.py`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.vision import band
from components.vision.band import Course
from components.vision.blob import Blob
from components.vision.edge import Line

Image = NDArray[np.uint8]
Changes = NDArray[np.float32]
"""`[rows - 2, STRETCHES]`: how much nearer to the stripe's colour the next row is than the last one, grey levels."""

STRETCHES = 10
LENGTH_MIN_PX = 40
"""A shorter band is not looked at."""
THIN_PX = 2
"""Borders nearer than this at an end are the same."""
CHANGE_MIN = 4.0
"""Less change on the mean is no border. In the simulator a stripe's are 8 and more in a tenth of the light, those of a
table without one 1.3."""
PASSES = 2


class Box(NamedTuple):
    """Pixels from the first to the last, both included."""

    left_px: int
    top_px: int
    right_px: int
    bottom_px: int

    @classmethod
    def of(cls, patch: Blob) -> Box:
        """Around a patch."""
        rows, columns = patch.mask.shape
        return cls(patch.left_px, patch.top_px, patch.left_px + columns - 1, patch.top_px + rows - 1)

    @classmethod
    def about(cls, pixels: NDArray[np.float64]) -> Box:
        """Around pixels `[M, 2]` (column, row)."""
        return cls(*pixels.min(axis=0).astype(int).tolist(), *pixels.max(axis=0).astype(int).tolist())


def middle(image: Image, rough: Line, box: Box, reach_px: int, colour: Sequence[float]) -> Line | None:
    """The line midway between a stripe's borders; None if it has none there.

    Args:
        image: `[height, width, 3]` blue, green, red.
        rough: a line no further from either border than the reach.
        box: the stripe's.
        reach_px: rows (columns, if it is steep) on either side.
        colour: red, green, blue of the stripe under some lamp.
    """
    course = Course.of(rough)
    x = np.arange(box[course.steep], box[course.steep + 2] + 1)
    y = course.at(x)
    x = x[(y >= 0) & (y < image.shape[course.steep])]
    if len(x) < LENGTH_MIN_PX:
        return None
    changes = _changes(band.along(image, course, (int(x[0]), int(x[-1])), reach_px), colour)
    ends = _ends(changes)
    if ends is None:
        return None
    first, last = (_border(image, course, x, (start - reach_px + 1, end - reach_px + 1)) for start, end in ends)
    return first._replace(y_px=0.5 * (first.y_px + last.y_px), slope=0.5 * (first.slope + last.slope)).line


def _changes(pixels: band.Band, colour: Sequence[float]) -> Changes:
    """Across a band."""
    own = np.array(colour[::-1], np.float32)
    own -= own.mean()  # what is left is what no light makes of grey
    columns = pixels.shape[1] // STRETCHES * STRETCHES
    likeness = (pixels[:, :columns] @ (own / np.linalg.norm(own))).reshape(len(pixels), STRETCHES, -1).mean(axis=2)
    return np.asarray(likeness[2:] - likeness[:-2], np.float32)


def _ends(changes: Changes) -> tuple[tuple[int, int], tuple[int, int]] | None:
    """Rows of the changes at both ends of the border to the stripe's colour and of that from it, which comes after."""
    rows = np.arange(len(changes))
    share = (np.arange(STRETCHES) + 0.5) / STRETCHES
    passed = np.rint(rows[:, None, None] * (1.0 - share) + rows[:, None] * share).astype(np.intp)
    votes = changes[passed, np.arange(STRETCHES)].mean(axis=2)
    start, end = divmod(int(votes.argmax()), len(rows))
    thick = (rows[:, None] > start + THIN_PX) & (rows > end + THIN_PX)
    from_it = np.where(thick, -votes, -np.inf)
    if min(float(votes[start, end]), float(from_it.max())) < CHANGE_MIN:
        return None
    return (start, end), divmod(int(from_it.argmax()), len(rows))


def _border(image: Image, course: Course, x: band.Whole, ends: tuple[int, int]) -> Course:
    """One that lies so far from a line at its two ends."""
    start, end = ends
    centre = 0.5 * float(x[0] + x[-1])
    found = Course(
        centre,
        course.y_px + course.slope * (centre - course.x_px) + 0.5 * (start + end),
        course.slope + (end - start) / len(x),
        course.steep,
    )
    for _ in range(PASSES):
        found = band.tilted(image, found, x)
    return found
