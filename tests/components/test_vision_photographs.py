"""The eyes on real photographs: nothing is seen that is not there, and a can put into one is found."""

import math
from pathlib import Path

import cv2
import numpy as np
import pytest

from components.vision import jpeg
from components.vision.component import view
from components.vision.core import Eyes
from components.vision.params import Params

WIDTH, HEIGHT = 320, 240
MIDDLE = np.array([(WIDTH - 1) / 2, (HEIGHT - 1) / 2])
PHOTOGRAPHS = sorted((Path(__file__).parent.parent / "photographs").glob("*.jpg"))
EYES = Eyes(Params())
GREEN, ORANGE = (70, 170, 60), (30, 120, 240)
"""Blue, green, red of paint in good light."""


def photograph(file):
    return jpeg.decode(file.read_bytes(), WIDTH, HEIGHT)


def can_texture():
    """(colours, mask) of a can 80 px wide and 140 px high: a shaded side, an elliptic lid and bottom."""
    mask = np.zeros((180, 80), np.uint8)
    cv2.rectangle(mask, (0, 20), (79, 160), 255, -1)
    for row in (20, 160):
        cv2.ellipse(mask, (40, row), (39, 14), 0, 0, 360, 255, -1)
    light = 0.55 + 0.45 * np.cos(np.linspace(-1.3, 1.0, 80))
    colours = np.float32(GREEN) * np.float32(light)[None, :, None] * np.ones((180, 1, 1), np.float32)
    lid = cv2.ellipse(np.zeros_like(mask), (40, 20), (39, 14), 0, 0, 360, 255, -1) > 0
    colours[lid] = np.float32(GREEN) * 1.15
    return colours, mask


def put(image, colours, mask, corners, generator, light):
    """The photograph with a texture seen in perspective: `corners` [4, 2] px, clockwise from the upper left.

    Light scales its colours; the whole gets the noise and the JPEG of a camera. Returns (image, where [h, w] bool).
    """
    height, width = mask.shape
    edge = np.float32([(0, 0), (width - 1, 0), (width - 1, height - 1), (0, height - 1)])
    warp = cv2.getPerspectiveTransform(edge, np.float32(corners))
    share = cv2.warpPerspective(mask, warp, (WIDTH, HEIGHT), flags=cv2.INTER_AREA)[..., None] / 255.0
    shown = cv2.warpPerspective(colours * light, warp, (WIDTH, HEIGHT))
    mixed = image * (1.0 - share) + shown * share + generator.normal(0.0, 5.0, image.shape)
    data = cv2.imencode(".jpg", np.uint8(np.clip(mixed, 0, 255)), [cv2.IMWRITE_JPEG_QUALITY, 75])[1].tobytes()
    return jpeg.decode(data, WIDTH, HEIGHT), share[..., 0] > 0.5


def can_corners(generator):
    """A can 14 to 60 px wide, a little narrower at the bottom, as from above."""
    width = math.exp(generator.uniform(math.log(14), math.log(60)))
    height, narrow = 2.25 * width, generator.uniform(0.0, 0.08) * width
    left = generator.uniform(2, WIDTH - width - 2)
    top = generator.uniform(2, max(3.0, HEIGHT - height - 2))
    right, low = left + width, top + height
    return [(left, top), (right, top), (right - narrow, low), (left + narrow, low)]


@pytest.mark.parametrize("file", PHOTOGRAPHS, ids=lambda file: file.stem)
def test_a_photograph_without_can_and_stripe_shows_neither(file):
    sight = EYES.look(photograph(file))
    assert (sight.spot, sight.border) == (None, None)


def test_there_are_photographs_and_each_is_named_with_its_licence():
    words = (PHOTOGRAPHS[0].parent / "README.md").read_text(encoding="utf-8")
    assert len(PHOTOGRAPHS) >= 8
    assert all(f"| {file.name} |" in words for file in PHOTOGRAPHS)


@pytest.mark.parametrize("file", PHOTOGRAPHS, ids=lambda file: file.stem)
def test_a_can_in_a_photograph_is_found_where_it_is(file):
    generator = np.random.default_rng(8)
    image = photograph(file)
    for _ in range(10):
        colours, mask = can_texture()
        seen, where = put(image, colours, mask, can_corners(generator), generator, generator.uniform(0.7, 1.2))
        spot = EYES.look(seen).spot
        assert spot is not None
        rows, columns = np.nonzero(where)
        middle = np.array([np.median(columns), np.median(rows)]) - MIDDLE
        assert np.hypot(*(np.array(spot[:2]) - middle)) < 2.0 + 0.03 * np.ptp(rows)


@pytest.mark.parametrize("file", PHOTOGRAPHS, ids=lambda file: file.stem)
def test_a_stripe_in_a_photograph_is_found_or_nothing_is(file):
    """Where something larger is orange too the stripe is passed over; never is another thing called one."""
    generator = np.random.default_rng(9)
    image, found = photograph(file), 0
    stripe = np.float32(ORANGE) * np.ones((20, 200, 3), np.float32)
    for _ in range(8):
        row, slope, half = generator.uniform(60, 180), generator.uniform(-0.3, 0.3), generator.uniform(3.5, 6.0)
        left, right = row - slope * MIDDLE[0], row + slope * MIDDLE[0]
        corners = [(-2, left - half), (WIDTH + 1, right - half), (WIDTH + 1, right + half), (-2, left + half)]
        light = generator.uniform(0.75, 1.1)
        seen, _ = put(image, stripe, np.full((20, 200), 255, np.uint8), corners, generator, light)
        border = EYES.look(seen).border
        if border is not None:
            found += 1
            assert border.slope == pytest.approx(slope, abs=0.02)
            assert border.v_px == pytest.approx(row - MIDDLE[1], abs=2.0)
    assert found >= 6 or file.stem in {"astronaut", "cat", "coffee", "flower", "retina"}


def test_a_round_thing_of_the_stripes_colour_is_no_edge_and_leaves_are_no_object():
    image = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
    cv2.circle(image, (160, 120), 60, ORANGE, -1)
    for angle in range(0, 360, 45):
        tip = (60 + round(50 * math.cos(math.radians(angle))), 60 + round(50 * math.sin(math.radians(angle))))
        cv2.line(image, (60, 60), tip, GREEN, 3)
    assert not view(EYES.look(image)).edge_visible
    assert not view(EYES.look(image)).object_visible


def test_a_kite_of_the_stripes_colour_is_long_and_straight_but_not_even():
    image = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
    cv2.fillPoly(image, [np.array([(20, 120), (160, 95), (300, 120), (160, 145)])], ORANGE)
    assert not view(EYES.look(image)).edge_visible
    image[:] = 90
    cv2.fillPoly(image, [np.array([(20, 112), (300, 116), (300, 124), (20, 128)])], ORANGE)
    assert view(EYES.look(image)).edge_visible
