"""The largest connected patch of a mask, and its median."""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.uint8]


class Blob(NamedTuple):
    """A patch, cut out of its image."""

    mask: Mask
    """`[rows, columns]`, 255 where the patch is, else 0."""
    left_px: int
    """Image column of the first column of `mask`."""
    top_px: int
    """Image row of the first row of `mask`."""
    pixels: int
    """How many belong to the patch."""


def largest(mask: Mask, pool: int) -> Blob | None:
    """The largest patch of a mask of 0 and 255, or None."""
    return next(iter(patches(mask, pool, 1)), None)


def patches(mask: Mask, pool: int, most: int) -> list[Blob]:
    """The largest patches of a mask of 0 and 255, at most so many, the largest first.

    Patches are told apart in an image `pool` times smaller (a divisor of both sides), in which a small pixel is set if
    any of its pixels is: several times faster, and a gap of a pixel does not tear a thin stripe.
    """
    height, width = mask.shape
    pooled = cv2.resize(mask, (width // pool, height // pool), interpolation=cv2.INTER_AREA)
    x0, y0, w0, h0 = cv2.boundingRect(pooled)
    if w0 == 0:
        return []
    _, labels, stats, _ = cv2.connectedComponentsWithStats(pooled[y0 : y0 + h0, x0 : x0 + w0], ltype=cv2.CV_16U)
    order = 1 + np.argsort(-stats[1:, cv2.CC_STAT_AREA], kind="stable")[:most]
    whole = np.asarray(labels)
    return [_cut_out(mask, whole, int(label), stats[label, :4].tolist(), (x0, y0), pool) for label in order]


def _cut_out(
    mask: Mask, labels: NDArray[np.generic], label: int, box: list[int], origin: tuple[int, int], pool: int
) -> Blob:
    x, y, w, h = box
    kept = np.uint8(255) * (labels[y : y + h, x : x + w] == label)
    whole = cv2.resize(kept, (w * pool, h * pool), interpolation=cv2.INTER_NEAREST)
    left, top = (origin[0] + x) * pool, (origin[1] + y) * pool
    patch = np.asarray(cv2.bitwise_and(mask[top : top + h * pool, left : left + w * pool], whole), np.uint8)
    return Blob(patch, left, top, cv2.countNonZero(patch))


def median(blob: Blob) -> tuple[float, float]:
    """(column, row) in the image of the medians of the patch's pixels, between pixels where they fall there."""
    columns = cv2.reduce(blob.mask, 0, cv2.REDUCE_SUM, dtype=cv2.CV_32S).ravel()
    rows = cv2.reduce(blob.mask, 1, cv2.REDUCE_SUM, dtype=cv2.CV_32S).ravel()
    return blob.left_px + _middle(columns), blob.top_px + _middle(rows)


def _middle(counts: NDArray[np.generic]) -> float:
    """Where half of the counts lie on either side; a count is spread evenly over its pixel."""
    total = np.cumsum(counts)
    half = 0.5 * float(total[-1])
    index = int(np.searchsorted(total, half))
    before = float(total[index - 1]) if index else 0.0
    return index - 0.5 + (half - before) / float(counts[index])
