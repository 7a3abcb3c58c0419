"""A band is tilted until it is the same from end to end: drawn borders, their light, what stands before them."""

import math

import cv2
import numpy as np
import pytest

from components.vision import band
from components.vision.edge import Line
from docking.angles import DEG

HEIGHT, WIDTH = 240, 320
COLUMNS = np.arange(WIDTH, dtype=float)
TOP, STRIPE = np.array((112.0, 148.0, 178.0)), np.array((22.0, 122.0, 242.0))
"""Equally bright: the border between them is one of colour alone."""


def drawn(slope, row=120.0, light=1.0, noise_grey=0.0):
    """Two colours `[h, w, 3]` on either side of a line through the middle column; light falls to the right."""
    away = np.arange(HEIGHT)[:, None] - row - slope * (COLUMNS - 160.0)
    share = np.clip(away / math.hypot(1.0, slope) + 0.5, 0.0, 1.0)[..., None]
    image = (TOP * (1 - share) + STRIPE * share) * np.linspace(1.0, light, WIDTH)[:, None]
    image += np.random.default_rng(3).normal(0.0, noise_grey, image.shape)
    return np.uint8(np.clip(np.rint(image), 0, 255))


def straightened(image, true, guess, row=120.0):
    """Angle in degrees between a true slope and the one that a guess is tilted to."""
    rows = row + guess * (COLUMNS - 160.0)
    line = band.straightened(image, Line(160.0, row, guess), np.column_stack((COLUMNS, np.rint(rows))))
    assert (line.column_px, line.row_px) == (160.0, row)
    return (math.atan(line.slope) - math.atan(true)) / DEG


@pytest.mark.parametrize("slope", [-0.6, -0.2, 0.0, 0.013, 0.35, 0.9])
@pytest.mark.parametrize("off", [-0.006, 0.006])
def test_a_line_that_is_a_pixel_off_at_its_ends_is_tilted_to_the_border(slope, off):
    assert abs(straightened(drawn(slope), slope, slope + off)) < 0.1 < math.degrees(abs(off)) / (1 + slope**2)


def test_light_that_falls_along_the_border_is_no_tilt():
    assert abs(straightened(drawn(0.2, light=0.6), 0.2, 0.2)) < 0.02


def test_the_transposed_image_gives_the_transposed_line():
    image = drawn(0.3)[:, :HEIGHT]
    columns = COLUMNS[:HEIGHT]
    pixels = np.column_stack((columns, 120.0 + 0.303 * (columns - 160.0)))
    flat = band.straightened(image, Line(160.0, 120.0, 0.303), pixels)
    turned = np.ascontiguousarray(image.transpose(1, 0, 2))
    steep = band.straightened(turned, Line(120.0, 160.0, 1 / 0.303), pixels[:, ::-1])
    assert steep.slope == pytest.approx(1.0 / flat.slope, rel=1e-4)


def test_in_a_jpeg_that_keeps_half_of_the_colour_a_border_of_colour_is_told_to_some_hundredths_of_a_degree():
    image = drawn(0.1, noise_grey=3.0)
    settings = (cv2.IMWRITE_JPEG_QUALITY, 80, cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_420)
    seen = cv2.imdecode(cv2.imencode(".jpg", image, settings)[1], cv2.IMREAD_COLOR)
    assert abs(straightened(seen, 0.1, 0.102)) < 0.04


def test_what_stands_before_the_border_does_not_tilt_it():
    image = drawn(0.1, noise_grey=3.0)
    image[80:160, 280:] = (60, 170, 40)
    assert abs(straightened(image, 0.1, 0.1)) < 0.03


@pytest.mark.parametrize("colour", [(0, 0, 0), (112, 148, 178)])
def test_where_there_is_no_border_nothing_is_tilted(colour):
    image = np.full((HEIGHT, WIDTH, 3), colour, np.uint8)
    assert abs(straightened(image, 0.1, 0.1)) < 1e-6


@pytest.mark.parametrize("reddening", [0.2, 0.4])
def test_what_would_move_an_end_far_is_another_thing(reddening):
    """A colour that fades as light does: a shift looks like light, and what is left of it says nothing."""
    rows = 255.0 * np.exp(-0.01 * np.arange(HEIGHT))[:, None, None] * np.ones((1, WIDTH, 3))
    rows[..., 2] *= 1.0 + reddening * (COLUMNS - 160.0) / 160.0
    assert straightened(np.uint8(np.clip(np.rint(rows), 0, 255)), 0.0, 0.0) == 0.0


def test_noise_breaks_nothing():
    for seed in range(20):
        image = np.random.default_rng(seed).integers(0, 255, (HEIGHT, WIDTH, 3), np.uint8)
        assert math.isfinite(straightened(image, 0.0, 0.0))


def test_a_line_along_the_images_border_is_left_as_it_is():
    assert straightened(drawn(0.0, row=1.0), 0.0, 0.0, row=1.0) == 0.0
