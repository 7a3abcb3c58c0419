"""The table's edge: a straight line through the stripe, by least squares.

Each column of the stripe gives the mean row of its pixels, and the line is the regression of these on the column.
Unlike the principal axis of the pixels, it is exact for a band of any thickness, which is what a stripe of constant
height is. Where the stripe leaves through the image's upper or lower border a column shows only part of it and would
pull the line level: such columns are left out. A stripe that is higher than it is wide is treated the same way with
rows and columns exchanged, so that no slope is steep.

Much in the world is orange: skin, wood, a cat. A stripe is long, straight and even; what is not is none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.vision.blob import Blob

Array = NDArray[np.float64]

END_PX = 2
"""Columns left out at either end and beside an incomplete one: antialiasing, JPEG blocks, the table's corner."""
OUTLIER_PX = 2.0
"""A mean further than this from the first line is another thing that touches the stripe."""
LINES_MIN = 8
"""Fewer columns (rows) are no line."""
WHOLE_MIN = 0.25
"""Smaller shares of whole columns are a large thing at the image's border, not a band: 0.08 of a wooden table."""
STRAIGHT_MIN = 0.8
"""Smaller shares of columns near the line are no stripe. In the simulator 0.97 and more; of nine false ones in
photographs eight have up to 0.62."""
EVEN_MIN = 0.8
"""Nor are smaller shares of columns as high as a band, whose height changes evenly from end to end, would have them: to
EVEN_SHARE of it, or EVEN_PX. In the simulator 0.9 and more; the ninth has 0.62."""
EVEN_SHARE, EVEN_PX = 0.25, 1.5
VERTICAL = 1e-6
"""Smaller slopes of rows are a vertical line, whose slope can not be told."""
LONG_MIN = 4.0
"""Nor is what is less long than this many heights. In the simulator 8 and more."""


class Line(NamedTuple):
    """v = row_px + slope (u - column_px), in image columns and rows from the upper left corner."""

    column_px: float
    row_px: float
    slope: float

    def row_at(self, column_px: float) -> float:
        """Row at which the line crosses a column."""
        return self.row_px + self.slope * (column_px - self.column_px)


def line(stripe: Blob, height_px: int, width_px: int) -> Line | None:
    """The line through the middle of a stripe in an image of that size; None if there are too few whole columns."""
    rows, columns = stripe.mask.shape
    if columns >= rows:
        fit = _regression(stripe.mask, stripe.top_px == 0, stripe.top_px + rows >= height_px)
        return fit and Line(stripe.left_px + fit[0], stripe.top_px + fit[1], fit[2])
    fit = _regression(stripe.mask.T, stripe.left_px == 0, stripe.left_px + columns >= width_px)
    if fit is None or abs(fit[2]) < VERTICAL:
        return None
    return Line(stripe.left_px + fit[1], stripe.top_px + fit[0], 1.0 / fit[2])


def _regression(mask: NDArray[np.uint8], at_first: bool, at_last: bool) -> tuple[float, float, float] | None:
    """(mean column, mean row, slope) of the whole columns of a mask; may its first, its last row be cut off?"""
    # Whole numbers that float32 holds exactly: the same sums on every processor.
    counts, sums = np.stack((np.ones(len(mask)), np.arange(len(mask)))).astype(np.float32) @ (mask & 1).astype(
        np.float32
    )
    cut = np.zeros(len(counts), bool)
    if at_first:
        cut |= mask[0] > 0
    if at_last:
        cut |= mask[-1] > 0
    used = np.flatnonzero(~_widened(cut) & (counts > 0.0))[END_PX:-END_PX]
    if len(used) < max(LINES_MIN, WHOLE_MIN * len(counts)):
        return None
    weights = counts[used].astype(np.float64)
    if not _is_even(used, weights):
        return None
    means = sums[used] / weights
    fit = _least_squares(used, means, weights)
    near = np.abs(means - fit[1] - fit[2] * (used - fit[0])) <= OUTLIER_PX
    if LINES_MIN <= np.count_nonzero(near) < len(used):
        fit = _least_squares(used[near], means[near], weights[near])
        near = np.abs(means - fit[1] - fit[2] * (used - fit[0])) <= OUTLIER_PX
    straight = np.count_nonzero(near) >= STRAIGHT_MIN * len(used)
    long = len(used) * (1.0 + fit[2] ** 2) >= LONG_MIN * weights.mean()
    return fit if straight and long else None


def _is_even(columns: NDArray[np.intp], heights: Array) -> bool:
    """Whether these are the columns of a band."""
    ones = np.ones(len(columns))
    middle, mean, slope = _least_squares(columns, heights, ones)
    band = mean + slope * (columns - middle)
    even = np.abs(heights - band) <= np.maximum(EVEN_SHARE * band, EVEN_PX)
    return bool(np.count_nonzero(even) >= EVEN_MIN * len(columns))


def _widened(cut: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return np.convolve(cut, np.ones(2 * END_PX + 1), mode="same") > 0.5 if cut.any() else cut


def _least_squares(x: NDArray[np.intp], y: Array, weights: Array) -> tuple[float, float, float]:
    """(mean x, mean y, slope) of the regression of y on x."""
    total = weights.sum()
    mean_x, mean_y = float(weights @ x / total), float(weights @ y / total)
    away = weights * (x - mean_x)
    return mean_x, mean_y, float(away @ (y - mean_y) / (away @ (x - mean_x)))
