"""The band of pixels along a line, which is tilted until the band is the same from end to end.

A border of brightness is told by the peak of the gradient in each column. In one of colour alone, of which a JPEG keeps
half, a single column tells little; but all of them show the same border, under a light that may change along it. So
what changes along the band is put down to a tilt, as far as it is what a shift would change (Lucas and Kanade 1981),
and to the light, as far as it is a share of the band itself.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from components.vision.edge import Line

Array = NDArray[np.float64]
Band = NDArray[np.float32]
"""`[rows, columns, 3]`, the line in the middle row."""
Image = NDArray[np.uint8]

REACH_PX = 3
"""Rows of the band on either side of the line. A stripe of 3 cm is 5 px high from 2 m."""
COLUMNS_MIN = 32
"""Fewer columns tell too little."""
MOST_PX = 1.5
"""What would move an end of the line further was no border."""
STRANGE = 3.0
"""Columns that differ from the mean by more than so many times what the middle one does are another thing."""


def straightened(image: Image, line: Line, pixels: Array) -> Line:
    """A line through some of an image's `[height, width, 3]` pixels `[M, 2]` (column, row), tilted about its point."""
    if abs(line.slope) <= 1.0:
        return line._replace(slope=_tilted(image, pixels[:, 0], (line.column_px, line.row_px, line.slope)))
    slope = _tilted(image, pixels[:, 1], (line.row_px, line.column_px, 1.0 / line.slope), steep=True)
    return line._replace(slope=1.0 / slope) if slope * line.slope > 0.0 else line


def _tilted(image: Image, x: Array, line: tuple[float, float, float], *, steep: bool = False) -> float:
    """Slope of y over x: of rows over columns, of columns over rows if it is steep."""
    middle, y, slope = line
    first, last = int(x.min()), int(x.max())
    columns = np.unique(x).astype(np.intp) - first
    rows = y + slope * (first + columns - middle)
    columns = columns[(rows >= REACH_PX) & (rows < image.shape[steep] - REACH_PX - 1)]
    if len(columns) < COLUMNS_MIN:
        return slope
    way = np.array(((1.0, 0.0, first), (slope, 1.0, y + slope * (first - middle) - REACH_PX)))
    size = (last - first + 1, 2 * REACH_PX + 1)
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    band = cv2.warpAffine(image, way[::-1] if steep else way, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return slope + _tilt(columns, np.asarray(band, np.float32)[:, columns])


def _tilt(columns: NDArray[np.intp], band: Band) -> float:
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
