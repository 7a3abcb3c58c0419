"""Learned colours: one look-up table from a pixel's colour to what it belongs to.

A colour is learned in one light. In another it is brighter or darker, up to where the camera clips, and its red and
blue shift against its green along the line of the black bodies (Finlayson and Hordley 2001, "Color constancy at a
pixel"). The table holds what each learned colour can look like in any of these lights, so that looking costs one pass.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from components.vision.colour import Thresholds
from components.vision.params import Params

Image = NDArray[np.uint8]
Mask = NDArray[np.uint8]
Cells = NDArray[np.bool_]
Colour = Sequence[float]
"""Red, green, blue in 0 .. 255."""

BITS = (5, 6, 5)
"""Of red, green and blue that a cell of the table is told by."""
GAMMA = 2.2
"""Pixel values are this root of the light."""
LIGHT_MIN, LIGHT_MAX = 0.1, 4.0
"""Light, against that in which the colour was learned."""
ROUND, FLAT = (0.62, 1.3), (0.72, 1.2)
"""Least and most of pixel values against where was pointed at: the sides of a round thing, and the image's corners."""
LEVEL_STEP = 1.05
SHIFT_MAX_PER_K, SHIFTS = 1.3e-4, 15
"""Between a lamp of 4000 K and those of 2700 and 6500 K the inverse colour temperature differs by up to 1.2e-4."""
SECOND_RADIATION_M_K = 0.014388
WAVELENGTHS_M = (640e-9, 540e-9, 430e-9)
"""Of red, green, blue in Wien's law; apart as far as those of a camera whose colours sRGB's matrix has sharpened."""
NOISE_GREY, SPREAD = 5.0, 0.1
"""A pixel is off by this much, and by this share: noise, JPEG, paint that is not even."""
BLEEDING = 0.09
"""Share of the strongest channel that an overexposed stripe's others are off by: a JPEG keeps half of the colour."""
CONTRAST_MIN = 12.0
"""Less between the strongest and the weakest channel is grey, which is everywhere in the dark."""


class Palette:
    """Judges one image after the other by learned colours; what was not learned, by thresholds."""

    def __init__(self, params: Params) -> None:
        self._thresholds = Thresholds(params)
        self._learned = bool(params.object_colour), bool(params.table_colour) or params.edge != "stripe"
        object_cells, table_cells = look(params.object_colour, ROUND), look(params.table_colour, FLAT, BLEEDING)
        both = object_cells & table_cells
        self._kinds = np.zeros(object_cells.size, np.uint8)
        self._kinds[object_cells & ~both] = 1
        self._kinds[table_cells & ~both] = 2

    def masks(self, image: Image) -> tuple[Mask, Mask]:
        """(object, table or stripe), each `[height, width]`, 255 where the colour fits, else 0."""
        packed = np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2BGR565), np.uint8).view("<u2")[..., 0]
        kinds = self._kinds.take(packed)
        found = tuple(np.asarray(cv2.inRange(kinds, kind, kind), np.uint8) for kind in (1, 2))
        if not all(self._learned):
            told = self._thresholds.masks(image)
            found = tuple(
                mine if learned else other for learned, mine, other in zip(self._learned, found, told, strict=True)
            )
        return found[0], found[1]


def look(colour: Colour, shade: tuple[float, float], bleeding: float = 0.0) -> Cells:
    """Cells that a colour can fall in, from its darkest to its brightest shade.

    `[2^16]` by 5 bits of red, 6 of green, 5 of blue; none without a colour.
    """
    cells = np.zeros([1 << bits for bits in BITS], bool)
    if len(colour):
        for seen in _appearances(np.array(colour), shade):
            cells[_box(seen, bleeding)] = True
    return cells.ravel()


def _appearances(colour: NDArray[np.float64], shade: tuple[float, float]) -> Iterator[NDArray[np.float64]]:
    """The colour in all lights, beyond 255 too."""
    low, high = shade[0] * LIGHT_MIN ** (1 / GAMMA), shade[1] * LIGHT_MAX ** (1 / GAMMA)
    levels = np.geomspace(low, high, 1 + math.ceil(math.log(high / low, LEVEL_STEP)))
    for shift_per_k in np.linspace(-SHIFT_MAX_PER_K, SHIFT_MAX_PER_K, SHIFTS):
        gain = lamp_gain(float(shift_per_k))
        for level in levels:
            seen = colour * gain * level
            if np.ptp(np.minimum(seen, 255.0)) >= CONTRAST_MIN:
                yield seen


def lamp_gain(shift_per_k: float) -> NDArray[np.float64]:
    """Factors on pixel values, red, green, blue, when the lamp's inverse temperature grows; Wien's law, green kept."""
    inverse_m = 1.0 / np.array(WAVELENGTHS_M)
    return np.asarray(np.exp((inverse_m[1] - inverse_m) * SECOND_RADIATION_M_K * shift_per_k / GAMMA))


def _box(seen: NDArray[np.float64], bleeding: float) -> tuple[slice, ...]:
    """Cells around a colour whose middles it may be taken for; a clipped channel is 255."""
    shown = np.minimum(seen, 255.0)
    off = NOISE_GREY + SPREAD * shown + bleeding * (shown.max() if seen.max() > 255.0 else 0.0)
    spans = []
    for value, reach, bits in zip(shown.tolist(), off.tolist(), BITS, strict=True):
        width = 256 >> bits
        first = max(0, math.ceil((value - reach) / width - 0.5))
        last = min((1 << bits) - 1, math.floor((value + reach) / width - 0.5))
        spans.append(slice(first, max(first, last) + 1))
    return tuple(spans)
