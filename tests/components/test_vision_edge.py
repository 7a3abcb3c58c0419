"""The line through a stripe, against stripes drawn by their own equation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.vision import blob, edge
from docking.angles import DEG

ROWS, COLUMNS = np.mgrid[0:240, 0:320]


def fitted(stripe):
    patch = blob.largest(np.where(stripe, 255, 0).astype(np.uint8), 2)
    return edge.line(patch, 240, 320)


def band(slope, thickness_px, column=159.5, row=119.5):
    """Pixels within `thickness_px` of a line, measured along the shorter way to it."""
    away = ROWS - row - slope * (COLUMNS - column)
    return np.abs(away) <= 0.5 * thickness_px * max(1.0, abs(slope))


@settings(max_examples=60, deadline=None)
@given(st.floats(-85, 85), st.floats(4, 40), st.floats(-60, 60), st.floats(-40, 40))
def test_a_band_of_any_thickness_and_slope_gives_its_own_line(angle_deg, thickness, right, down):
    """Also where the image cuts the band off on two sides."""
    slope = np.tan(angle_deg * DEG)
    line = fitted(band(slope, thickness, 159.5 + right, 119.5 + down))
    assert np.arctan(line.slope) == pytest.approx(np.arctan(slope), abs=0.35 * DEG)
    away = line.row_at(159.5 + right) - (119.5 + down)
    assert abs(away) / np.hypot(1, slope) < 0.7


@pytest.mark.parametrize("slope", [0.7, -0.7, 1.1, -1.1])
def test_columns_that_the_image_cuts_off_do_not_pull_a_thick_band_level(slope):
    assert np.arctan(fitted(band(slope, 50)).slope) == pytest.approx(np.arctan(slope), abs=0.1 * DEG)


@pytest.mark.parametrize("slope", [6.0, -6.0, 20.0])
def test_a_band_that_is_nearly_upright_keeps_its_slope(slope):
    assert np.arctan(fitted(band(slope, 8)).slope) == pytest.approx(np.arctan(slope), abs=0.1 * DEG)


def test_a_line_is_not_made_of_a_few_columns():
    short = np.zeros((240, 320), bool)
    short[100:104, 100:110] = True
    assert fitted(short) is None


def test_an_upright_stripe_has_no_slope():
    assert fitted((COLUMNS >= 100) & (COLUMNS < 108)) is None
