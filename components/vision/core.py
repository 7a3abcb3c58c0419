"""What can be seen in one image: the object's middle and the table's edge."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.vision import blob, borders, edge, hough
from components.vision.blob import Blob
from components.vision.borders import Box
from components.vision.colour import Mask, Thresholds
from components.vision.marker import Detector
from components.vision.palette import Palette
from components.vision.params import Params

STRIPES = 4
"""Patches of a learned colour that are looked at: in bright light yellow things have it too."""
BESIDE_PX = 4.0
"""The borders of a learned stripe are looked for within its mask's height and this."""
HIGHEST_PX = 30.0
"""And within this, in an image 320 wide. A stripe of 3 cm is 28 px high from 0.4 m."""
Image = NDArray[np.uint8]


class Spot(NamedTuple):
    """The object, px from the image centre."""

    u_px: float
    v_px: float
    pixels: int


class Border(NamedTuple):
    """The table's edge, px from the image centre."""

    slope: float
    v_px: float
    """Row at which it crosses the object's column, or the middle column if there is no object."""
    pixels: int


class Sight(NamedTuple):
    """What one image shows; None for what is not there."""

    spot: Spot | None
    border: Border | None


class Eyes:
    """Looks at images `[height_px, width_px, 3]` blue, green, red; the same image gives the same sight."""

    def __init__(self, params: Params) -> None:
        self._params = params
        learned = params.object_colour or params.table_colour
        self._colours = Palette(params) if learned else Thresholds(params)
        self._marker = Detector(params.marker_dictionary, params.marker_id) if params.object == "marker" else None
        self._middle = 0.5 * (params.width_px - 1)
        self._half = 0.5 * (params.height_px - 1)

    def look(self, image: Image) -> Sight:
        """Find object and edge. A pixel's centre has whole numbers, so the image centre lies between four of them."""
        is_object, is_table = self._colours.masks(image)
        thing, spot = self._thing(image, is_object)
        border = self._edge(image, is_table, thing, spot)
        if self._marker is None and thing and spot and self._stands_apart(thing, spot, border):
            return Sight(None, border and self._beside(border, spot))
        return Sight(spot, border)

    def _edge(self, image: Image, is_table: Mask, thing: Blob | None, spot: Spot | None) -> Border | None:
        if self._params.edge == "hough":
            return self._hough(image, thing, spot) if thing and spot else None
        stripes = blob.patches(is_table, self._params.pool, STRIPES if self._params.table_colour else 1)
        found = (self._stripe(image, stripe, spot.u_px if spot else 0.0) for stripe in stripes)
        border = next((border for border in found if border is not None), None)
        if border is None and self._params.table_colour and thing and spot:
            return self._hough(image, thing, spot)  # overexposed, or too dark: its border is still a line
        return border

    def _stands_apart(self, thing: Blob, spot: Spot, border: Border | None) -> bool:
        """Whether it is too far from the table's edge for its size, or too small to be told without one."""
        if border is None:
            return spot.pixels < self._params.object_lone_pixels_min * self._params.scale**2
        foot_px = thing.top_px + len(thing.mask) - self._half
        gap_px = (border.v_px - foot_px) / np.hypot(1.0, border.slope)
        return bool(gap_px > self._params.object_gap_max * max(thing.mask.shape))

    def _beside(self, border: Border, spot: Spot) -> Border | None:
        """The edge where there is no object: at the middle column; lines mean nothing without one."""
        if self._params.edge == "hough":
            return None
        return border._replace(v_px=border.v_px - border.slope * spot.u_px)

    def _thing(self, image: Image, is_object: Mask) -> tuple[Blob | None, Spot | None]:
        """The object: what hides the edge, and where it is."""
        if self._marker is None:
            patch = blob.largest(is_object, self._params.pool)
            return patch, self._spot(patch)
        marker = self._marker.find(image)
        if marker is None:
            return None, None
        column, row = marker.middle
        return marker.blob, Spot(column - self._middle, row - self._half, marker.pixels)

    def _spot(self, patch: Blob | None) -> Spot | None:
        if patch is None or patch.pixels < self._params.object_pixels_min * self._params.scale**2:
            return None
        if not self._cut_off(patch) and patch.pixels < self._params.object_whole_pixels_min * self._params.scale**2:
            return None
        if patch.pixels < self._params.object_fill_min * patch.mask.size:
            return None
        column, row = blob.median(patch)
        return Spot(column - self._middle, row - self._half, patch.pixels)

    def _cut_off(self, patch: Blob) -> bool:
        """Whether the image's border may hide a part of it."""
        rows, columns = patch.mask.shape
        right, low = self._params.width_px - patch.left_px - columns, self._params.height_px - patch.top_px - rows
        return bool(min(patch.left_px, patch.top_px, right, low) <= 0)

    def _stripe(self, image: Image, stripe: Blob, u_px: float) -> Border | None:
        if stripe.pixels < self._params.edge_pixels_min * self._params.scale**2:
            return None
        if max(stripe.mask.shape) < self._params.edge_length_min_px * self._params.scale:
            return None
        line = edge.line(stripe, self._params.height_px, self._params.width_px)
        if line is None:
            return None
        reach_px = stripe.pixels / max(stripe.mask.shape) + BESIDE_PX
        return self._border(self._between(image, line, Box.of(stripe), reach_px), u_px, stripe.pixels)

    def _hough(self, image: Image, thing: Blob, spot: Spot) -> Border | None:
        length_min_px = self._params.edge_length_min_px * self._params.scale
        found = hough.edge(image, thing, self._middle + spot.u_px, length_min_px)
        if found is None:
            return None
        line = found.line
        if self._params.edge == "stripe":
            line = self._between(image, line, Box.about(found.pixels), HIGHEST_PX * self._params.scale)
        return self._border(line, spot.u_px, len(found.pixels))

    def _between(self, image: Image, line: edge.Line, box: Box, reach_px: float) -> edge.Line:
        """The line between the borders of a learned stripe; the rough one if it shows none."""
        if not self._params.table_colour:
            return line
        reach = round(min(reach_px, HIGHEST_PX * self._params.scale))
        return borders.middle(image, line, box, reach, self._params.table_colour) or line

    def _border(self, line: edge.Line, u_px: float, pixels: int) -> Border:
        return Border(line.slope, line.row_at(self._middle + u_px) - self._half, pixels)
