"""The table's edge without a stripe: in rendered and disturbed scenes, in photographs, against drawn lines."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.scenes import Room, decoded
from components.simulator.params import Params as WorldParams
from components.vision.core import Eyes
from components.vision.params import Params
from docking.angles import DEG
from tests.components.test_vision_photographs import (
    GREEN,
    HEIGHT,
    MIDDLE,
    ORANGE,
    PHOTOGRAPHS,
    WIDTH,
    can_texture,
    photograph,
    put,
)

EYES = Eyes(Params(edge="hough"))
PLAIN = Room(WorldParams(stripe=False))
STRIPED = Room(WorldParams())
WOOD, SHADE = (112, 148, 178), (70, 92, 114)
ROWS, COLUMNS = np.mgrid[0:HEIGHT, 0:WIDTH]


@pytest.mark.parametrize("room", [PLAIN, STRIPED], ids=["plain", "striped"])
def test_the_edge_is_the_projection_of_the_tables_border_with_and_without_a_stripe(room):
    angles, rows = [], []
    for view in room.views(150):
        sight = EYES.look(decoded(view.data))
        row, slope = room.edge(view.camera, sight.spot.u_px, "hough")
        angles.append(np.arctan(sight.border.slope) - np.arctan(slope))
        rows.append(sight.border.v_px - row)
    angles = np.array(angles) / DEG
    assert np.percentile(np.abs(angles), 95) < 0.1
    assert np.abs(angles).max() < 0.3
    assert abs(angles.mean()) < 0.02
    assert np.percentile(np.abs(rows), 95) < 1.1


@pytest.mark.parametrize("beta_deg", [-75, -70, 65, 70, 75])
@pytest.mark.parametrize("d", [0.4, 0.8, 1.5])
def test_steep_edges_are_not_pulled_level(beta_deg, d):
    view = PLAIN.view(PLAIN.camera(beta_deg * DEG, d))
    sight = EYES.look(decoded(view.data))
    _, slope = PLAIN.edge(view.camera, sight.spot.u_px, "hough")
    assert np.arctan(sight.border.slope) == pytest.approx(np.arctan(slope), abs=0.25 * DEG)


def test_the_mirrored_image_gives_the_mirrored_edge():
    image = decoded(PLAIN.view(PLAIN.camera(0.5, 1.0, 0.05)).data)
    here, mirrored = EYES.look(image).border, EYES.look(np.ascontiguousarray(image[:, ::-1])).border
    assert mirrored.slope == pytest.approx(-here.slope, abs=1e-3)
    assert mirrored.v_px == pytest.approx(here.v_px, abs=0.1)


def test_a_larger_image_gives_the_same_slope():
    room = Room(WorldParams(stripe=False, width_px=640))
    small = EYES.look(decoded(PLAIN.view(PLAIN.camera(0.5, 1.0)).data)).border
    large = Eyes(Params(edge="hough", width_px=640, height_px=480)).look(decoded(room.view(room.camera(0.5, 1.0)).data))
    assert large.border.slope == pytest.approx(small.slope, abs=3e-3)
    assert large.border.v_px == pytest.approx(2 * small.v_px, abs=1.5)


def test_without_an_object_nothing_is_the_edge():
    views = (decoded(view.data) for view in Room(WorldParams(stripe=False, distractors=False)).empty_views(20))
    assert all(EYES.look(image).border is None for image in views)
    assert all(EYES.look(photograph(file)).border is None for file in PHOTOGRAPHS)


def drawn(away, colour=WOOD, below=SHADE):
    """A can before a table whose front is where `away` [h, w] px, the way down from its border, is positive."""
    share = np.clip(away + 0.5, 0.0, 1.0)[..., None]
    image = np.uint8(np.round(np.float32(colour) * (1 - share) + np.float32(below) * share))
    image[60:100, 150:170] = GREEN
    return image


def border(angle_deg, row=130.0):
    slope = math.tan(angle_deg * DEG)
    return (ROWS - row - slope * (COLUMNS - MIDDLE[0])) / math.hypot(1.0, slope), slope


@settings(max_examples=40, deadline=None)
@given(st.floats(-75, 75), st.floats(112, 180))
def test_a_border_of_any_slope_gives_its_own_line(angle_deg, row):
    away, slope = border(angle_deg, row)
    found = EYES.look(drawn(away)).border
    assert np.arctan(found.slope) == pytest.approx(np.arctan(slope), abs=0.1 * DEG)
    at = row - MIDDLE[1] + slope * (159.5 - MIDDLE[0])
    assert abs(found.v_px - at) / math.hypot(1.0, slope) < 0.3


@pytest.mark.parametrize("other", [-4, 3])
def test_of_the_lines_below_the_object_the_uppermost_long_one_is_the_edge(other):
    image = drawn(border(0.0)[0])
    image[border(other, 200.0)[0] > 0] = (40, 200, 220)
    image[110:113, 60:90] = 20  # nearer, but short
    found = EYES.look(image).border
    assert found.slope == pytest.approx(0.0, abs=2e-3)
    assert found.v_px == pytest.approx(130 - MIDDLE[1], abs=0.6)


def test_a_line_above_the_object_is_not_the_edge():
    image = np.full((HEIGHT, WIDTH, 3), WOOD, np.uint8)
    image[:40] = 60
    image[60:100, 150:170] = GREEN
    assert EYES.look(image).border is None


@pytest.mark.parametrize("colour", [GREEN, WOOD])
def test_an_image_of_one_colour_breaks_nothing(colour):
    assert EYES.look(np.full((HEIGHT, WIDTH, 3), colour, np.uint8)).border is None


def test_random_noise_breaks_nothing():
    rng = np.random.default_rng(0)
    for _ in range(10):
        image = rng.integers(0, 255, (HEIGHT, WIDTH, 3), np.uint8)
        image[60:100, 150:170] = GREEN
        found = EYES.look(image).border
        assert found is None or np.isfinite(found).all()


BARE = ((WOOD, -40.0, 0.0), (SHADE, 0.0, 300.0))
STRIPE_PX = 10.0
STRIPED_TABLE = (*BARE, (ORANGE, 0.0, STRIPE_PX))


def table(image, row, slope, generator, parts=BARE):
    """The photograph behind a table: its top 40 px high, its front to the image's lower border."""
    left, right = row - slope * MIDDLE[0], row + slope * MIDDLE[0]
    light = generator.uniform(0.75, 1.1)
    for colour, above, below in parts:
        corners = [(-2, left + above), (WIDTH + 1, right + above), (WIDTH + 1, right + below), (-2, left + below)]
        mask = np.full((round(below - above), WIDTH), 255, np.uint8)
        image, _ = put(
            image, np.float32(colour) * np.ones((*mask.shape, 3), np.float32), mask, corners, generator, light
        )
    return image


def cans_on_tables(file, count, parts=BARE):
    """(image, row at the middle column, slope) of cans near the edge of a table before a photograph."""
    generator = np.random.default_rng(10)
    for _ in range(count):
        row, slope = generator.uniform(130, 200), generator.uniform(-0.3, 0.3)
        image = table(photograph(file), row, slope, generator, parts)
        centre, width = generator.uniform(80, 240), generator.uniform(14, 40)
        foot = row + slope * (centre - MIDDLE[0]) - generator.uniform(5, 12)
        left, right, top = centre - width / 2, centre + width / 2, foot - 2.25 * width
        corners = [(left, top), (right, top), (right, foot), (left, foot)]
        colours, mask = can_texture()
        yield put(image, colours, mask, corners, generator, generator.uniform(0.7, 1.2))[0], row, slope


@pytest.mark.parametrize("file", PHOTOGRAPHS, ids=lambda file: file.stem)
def test_a_can_on_a_table_before_a_photograph_stands_behind_the_tables_edge(file):
    for seen, row, slope in cans_on_tables(file, 6):
        sight = EYES.look(seen)
        assert sight.border.slope == pytest.approx(slope, abs=0.01)
        assert sight.border.v_px == pytest.approx(row + slope * sight.spot.u_px - MIDDLE[1], abs=1.5)


def off_rad(sight, slope):
    return abs(np.arctan(sight.border.slope) - np.arctan(slope))


def test_beside_a_stripe_lines_tell_the_slope_better_than_the_stripe_does():
    lines, stripes, by_stripe = [], [], Eyes(Params())
    for view in STRIPED.views(100):
        image = decoded(view.data)
        for eyes, edge, found in ((EYES, "hough", lines), (by_stripe, "stripe", stripes)):
            sight = eyes.look(image)
            found.append(off_rad(sight, STRIPED.edge(view.camera, sight.spot.u_px, edge)[1]))
    assert np.percentile(lines, 95) <= np.percentile(stripes, 95)


def test_before_photographs_lines_are_off_by_no_more_than_one_and_a_half_times_what_the_stripe_is():
    lines, stripes, by_stripe = [], [], Eyes(Params())
    for file in PHOTOGRAPHS:
        for image, _, slope in cans_on_tables(file, 5, STRIPED_TABLE):
            sight = by_stripe.look(image)
            if sight.border is not None:  # where more of the photograph is orange it is passed over
                stripes.append(off_rad(sight, slope))
                lines.append(off_rad(EYES.look(image), slope))
    assert len(lines) >= 25
    assert np.percentile(lines, 95) <= 1.5 * np.percentile(stripes, 95)
