"""A stripe is told by its two borders near a rough line, whatever was taken for it; without borders by nothing."""

import math

import numpy as np
import pytest

from components.vision import borders
from components.vision.borders import Box
from components.vision.edge import Line
from docking.angles import DEG

HEIGHT, WIDTH = 240, 320
ROWS, COLUMNS = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
TOP, STRIPE, APRON, FLOOR = (np.array(c) for c in ((112, 148, 178), (22, 122, 242), (70, 92, 114), (98, 106, 112)))
COLOUR = tuple(float(part) for part in STRIPE[::-1])
WHOLE = Box(0, 0, WIDTH - 1, HEIGHT - 1)


def row(line):
    at, slope = line
    return at + slope * (COLUMNS - 160.0)


def drawn(upper, lower, light=1.0, noise_grey=2.0, stripe=STRIPE):
    """A table's front: lines (row at column 160, slope) where the stripe begins and ends; the apron is higher."""
    image = TOP * np.ones((HEIGHT, WIDTH, 1))
    apron = 3.0 * row(lower) - 2.0 * row(upper)
    for below, colour in ((row(upper), stripe), (row(lower), APRON), (apron, FLOOR)):
        share = np.clip(ROWS - below + 0.5, 0.0, 1.0)[..., None]
        image = image * (1 - share) + colour * share
    image = light * image + np.random.default_rng(2).normal(0.0, noise_grey, image.shape)
    return np.uint8(np.clip(np.rint(image), 0, 255))


@pytest.mark.parametrize("light", [0.35, 1.0])
@pytest.mark.parametrize(
    ("upper", "lower"), [((118, 0.0), (127, 0.0)), ((100, 0.2), (112, 0.23)), ((90, -0.5), (98, -0.47))]
)
@pytest.mark.parametrize(("off_px", "off_slope"), [(0.0, 0.0), (6.0, 0.03), (-4.0, -0.02)])
def test_the_line_is_midway_between_the_borders_wherever_the_rough_one_is(light, upper, lower, off_px, off_slope):
    middle = [0.5 * (mine + other) for mine, other in zip(upper, lower, strict=True)]
    rough = Line(160.0, middle[0] + off_px, middle[1] + off_slope)
    found = borders.middle(drawn(upper, lower, light), rough, WHOLE, 20, COLOUR)
    assert math.atan(found.slope) == pytest.approx(math.atan(middle[1]), abs=0.1 * DEG)
    assert found.row_at(160.0) == pytest.approx(middle[0], abs=0.7)


def test_the_transposed_image_gives_the_transposed_line():
    image, rough = drawn((100, 0.2), (112, 0.23)), Line(160.0, 106.0, 0.21)
    flat = borders.middle(image, rough, WHOLE, 16, COLOUR)
    turned = np.ascontiguousarray(image.transpose(1, 0, 2))
    steep = borders.middle(turned, Line(106.0, 160.0, 1 / 0.21), Box(0, 0, HEIGHT - 1, WIDTH - 1), 16, COLOUR)
    assert steep.slope == pytest.approx(1.0 / flat.slope, rel=1e-3)


def test_the_image_upside_down_gives_the_line_upside_down():
    image, rough = drawn((100, 0.2), (112, 0.23)), Line(160.0, 106.0, 0.21)
    found = borders.middle(image, rough, WHOLE, 16, COLOUR)
    turned = borders.middle(np.ascontiguousarray(image[::-1]), Line(160.0, 133.0, -0.21), WHOLE, 16, COLOUR)
    assert turned.slope == pytest.approx(-found.slope, abs=2e-3)


def test_what_stands_before_a_part_of_the_stripe_does_not_turn_it():
    image = drawn((118, 0.0), (127, 0.0))
    image[60:130, 250:290] = (58, 152, 30)
    found = borders.middle(image, Line(160.0, 122.0, 0.0), WHOLE, 14, COLOUR)
    assert abs(math.atan(found.slope)) < 0.1 * DEG


@pytest.mark.parametrize(
    ("colour", "above"),
    [((0, 120, 255), -8.0), ((255, 255, 255), 24.0)],
    ids=["vivid above it", "white below it"],
)
def test_neither_a_stronger_border_before_it_nor_a_brighter_thing_behind_it_is_the_stripes(colour, above):
    """Rows within the reach, whose colour goes on beyond it."""
    image = drawn((118, 0.0), (127, 0.0), stripe=(60, 120, 190))
    end = 118 + above
    beside = end > ROWS if above < 0 else end < ROWS
    image[beside] = colour
    found = borders.middle(image, Line(160.0, 122.0, 0.0), WHOLE, 24, COLOUR)
    assert found.row_at(160.0) == pytest.approx(122.5, abs=0.7)


def test_a_table_without_a_stripe_has_no_borders_of_one():
    image = drawn((118, 0.1), (127, 0.1), light=0.35, stripe=APRON)
    assert borders.middle(image, Line(160.0, 118.0, 0.1), WHOLE, 20, COLOUR) is None


@pytest.mark.parametrize("grey", [0, 128, 255])
def test_an_image_of_one_colour_has_none(grey):
    image = np.full((HEIGHT, WIDTH, 3), grey, np.uint8)
    assert borders.middle(image, Line(160.0, 118.0, 0.1), WHOLE, 20, COLOUR) is None


def test_a_short_band_and_a_line_outside_of_the_image_have_none():
    image = drawn((118, 0.0), (127, 0.0))
    assert borders.middle(image, Line(160.0, 122.0, 0.0), Box(100, 110, 130, 130), 14, COLOUR) is None
    assert borders.middle(image, Line(160.0, 400.0, 0.1), WHOLE, 14, COLOUR) is None


def test_the_box_of_pixels_holds_the_first_and_the_last():
    assert Box.about(np.array([(3.0, 9.0), (7.0, 2.0)])) == Box(3, 2, 7, 9)
