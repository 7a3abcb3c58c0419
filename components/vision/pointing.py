"""A colour learned by pointing at it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.vision.palette import BLEEDING, FLAT, ROUND, look
from components.vision.params import COLOUR_MAX, CONTRAST_MIN

Image = NDArray[np.uint8]
Colour = tuple[float, ...]
"""Red, green, blue."""

WINDOW_PX = 5
"""Side of what is looked at around a point, in an image 320 wide."""
SPREAD_MAX = 40.0
"""More between the tenth and the ninetieth percentile of a channel is more than one colour."""
ALIKE_MAX = 0.1
"""A larger share of the object's colours that the stripe can have too is too much."""


class Region(NamedTuple):
    """Pixels from the image's upper left corner."""

    left_px: int
    top_px: int
    width_px: int
    height_px: int


class UnclearError(Exception):
    """Why no colour can be learned there, in words for a person."""


def around(u_px: int, v_px: int, image_width_px: int) -> Region:
    """A small square about a point."""
    half = max(1, round(WINDOW_PX * image_width_px / 640))
    return Region(u_px - half, v_px - half, 2 * half + 1, 2 * half + 1)


def colour(image: Image, region: Region) -> Colour:
    """Median red, green, blue of a region of an image `[height, width, 3]` blue, green, red.

    Raises:
        UnclearError: outside the image, overexposed, grey, or of several colours.
    """
    height, width, _ = image.shape
    left, top, columns, rows = region
    if columns < 1 or rows < 1 or left < 0 or top < 0 or left + columns > width or top + rows > height:
        raise UnclearError(f"must lie within the image of {width}x{height} px, 3 px from its border")
    pixels = image[top : top + rows, left : left + columns].reshape(-1, 3)[:, ::-1]
    found = np.median(pixels, axis=0)
    if found.max() > COLOUR_MAX:
        raise UnclearError("is overexposed; take the picture with a shorter exposure or less light")
    if np.ptp(found) < CONTRAST_MIN:
        raise UnclearError("is grey or too dark: it can not be told from other things under other lamps")
    low, high = np.percentile(pixels, (10, 90), axis=0)
    if (high - low).max() > SPREAD_MAX:
        raise UnclearError("has more than one colour; point at its middle")
    return tuple(round(float(part), 1) for part in found)


def check_apart(thing: Colour, stripe: Colour) -> None:
    """Refuse two colours that other lamps would mix up.

    Raises:
        UnclearError: they are too much alike.
    """
    mine, other = look(thing, ROUND), look(stripe, FLAT, BLEEDING)
    if np.count_nonzero(mine & other) > ALIKE_MAX * np.count_nonzero(mine):
        raise UnclearError("has a colour that under other lamps looks like the object's; use another or leave it away")
