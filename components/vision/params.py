"""What the eyes take for the object and for the edge. Standard library only."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from runtime.params import ConfigurationError, between, one_of, positive, ruled

COLOUR = "empty, or red, green, blue, each between 0 and 250, at least 30 apart"
COLOUR_MAX = 250.0
"""More is overexposed."""
CONTRAST_MIN = 30.0
"""Less between the strongest and the weakest channel is grey under some lamp."""


class Dictionary(NamedTuple):
    """A set of markers that OpenCV knows."""

    name: str
    """In `cv2.aruco`."""
    markers: int
    """They are numbered from 0."""


DICTIONARIES: Mapping[str, Dictionary] = {
    "aruco-4x4": Dictionary("DICT_4X4_50", 50),
    "aruco-5x5": Dictionary("DICT_5X5_50", 50),
    "aruco-6x6": Dictionary("DICT_6X6_50", 50),
    "apriltag-16h5": Dictionary("DICT_APRILTAG_16H5", 30),
    "apriltag-25h9": Dictionary("DICT_APRILTAG_25H9", 35),
    "apriltag-36h11": Dictionary("DICT_APRILTAG_36H11", 587),
}
"""The fewer cells, the further away it is seen: a marker of 4x4 bits has 6x6 cells with its border, 36h11 has 8x8."""


def _is_colour(colour: tuple[float, ...]) -> bool:
    in_range = len(colour) == 3 and all(0.0 <= part <= COLOUR_MAX for part in colour)
    return not colour or (in_range and max(colour) - min(colour) >= CONTRAST_MIN)


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    width_px: int = ruled(320, "a multiple of 8 between 64 and 1920", lambda px: 64 <= px <= 1920 and px % 8 == 0)
    """Images of any other size are refused, before they are decoded."""
    height_px: int = ruled(240, "a multiple of 8 between 48 and 1440", lambda px: 48 <= px <= 1440 and px % 8 == 0)
    """As above."""
    object: str = one_of("colour", "colour", "marker")
    """What the object is told by: a colour of its own, or a square marker on it."""
    marker_dictionary: str = one_of("aruco-4x4", *DICTIONARIES)
    """Of which kind the marker is."""
    marker_id: int = between(0, 0, 586)
    """Its number."""
    edge: str = one_of("stripe", "stripe", "hough")
    """How the table's edge is found: by the stripe on its front, or as the first long line below the object."""
    object_colour: tuple[float, ...] = ruled((), COLOUR, _is_colour)
    """Of the object in one image, learned by `berth calibrate colour`; the thresholds below are not used then."""
    table_colour: tuple[float, ...] = ruled((), COLOUR, _is_colour)
    """Likewise of the stripe on the table's edge; without a stripe no colour is needed."""
    green_over_others: int = between(36, 1, 254)
    """Object: green exceeds the larger of red and blue by at least this, of 255. Tuned in simulation."""
    red_over_green: int = between(40, 1, 254)
    """Stripe: red exceeds green by at least this ... Tuned in simulation."""
    green_over_blue: int = between(40, 1, 254)
    """... and green exceeds blue by at least this: orange, neither red nor yellow. Tuned in simulation."""
    object_pixels_min: int = positive(30)
    """Fewer pixels in an image 320 wide are not the object. A can 2.5 m away has 150."""
    object_whole_pixels_min: int = positive(30)
    """Nor are fewer that the image's border does not cut off."""
    object_fill_min: float = between(0.4, 0.0, 1.0)
    """Nor is a patch that fills less of its box, such as leaves. A can in a pooled box has 0.5 and more."""
    object_gap_max: float = positive(3.0)
    """Nor is one whose foot is further from the table's edge than so many of its own lengths: what is to be picked up
    stands at the edge. A can cut off anyhow has up to 1.8, a green cube of 1 cm, 25 cm behind the edge, 4.7 or more."""
    object_lone_pixels_min: int = positive(90)
    """Nor are fewer where no edge tells. A quarter of a can has 120 where the edge is out of sight."""
    edge_pixels_min: int = positive(60)
    """Fewer pixels in an image 320 wide are not the stripe."""
    edge_length_min_px: int = positive(64)
    """Nor is a blob that is shorter than this in an image 320 wide. In the simulator 119 and more are in view; real
    photographs have straight orange things of 54."""

    def __post_init__(self) -> None:
        """Check what no single field shows."""
        if self.marker_id >= (markers := DICTIONARIES[self.marker_dictionary].markers):
            raise ConfigurationError(
                f"vision.params.marker_id must be below {markers}, as many as {self.marker_dictionary} has; "
                f"got {self.marker_id}"
            )

    @property
    def pool(self) -> int:
        """Patches are told apart in an image this many times smaller."""
        return 2 if self.width_px <= 400 else 4

    @property
    def scale(self) -> float:
        """Of lengths, against an image 320 wide."""
        return self.width_px / 320.0
