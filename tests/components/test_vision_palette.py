"""Learned colours under other lamps, against the renderer's lamp, which is another model; what can not be learned."""

import numpy as np
import pytest

from benchmarks.scenes import Room, decoded
from components.simulator import lamp
from components.simulator.params import Params as WorldParams
from components.vision import palette, pointing
from components.vision.core import Eyes
from components.vision.params import Params
from components.vision.pointing import Region, UnclearError
from docking.angles import DEG

OBJECT, STRIPE = (22.0, 115.0, 45.0), (212.0, 108.0, 18.0)
LAMPS = [(2700, 0.1), (2700, 1.0), (2700, 4.0), (4000, 0.1), (4000, 4.0), (6500, 0.1), (6500, 1.0), (6500, 4.0)]
LEARNED = Params(edge="hough", object_colour=OBJECT)


@pytest.mark.parametrize(("lamp_k", "light"), LAMPS)
def test_colours_learned_in_one_light_are_known_in_others(lamp_k, light):
    room, eyes = Room(WorldParams(stripe=False, lamp_k=lamp_k, light=light)), Eyes(LEARNED)
    assert all(eyes.look(decoded(view.data)).spot is not None for view in room.partial_views(25))
    for view in room.views(25):
        sight = eyes.look(decoded(view.data))
        _, slope = room.edge(view.camera, sight.spot.u_px, "hough")
        assert np.arctan(sight.border.slope) == pytest.approx(np.arctan(slope), abs=0.3 * DEG)


@pytest.mark.parametrize(("lamp_k", "light"), [(2700, 0.1), (2700, 4.0), (5000, 0.1)])
def test_a_stripe_learned_in_one_light_is_told_by_its_borders_where_its_colour_is_not_known_well(lamp_k, light):
    room = Room(WorldParams(lamp_k=lamp_k, light=light))
    learned = Eyes(Params(object_colour=OBJECT, table_colour=STRIPE))
    for view in room.views(40, seed=5):
        sight = learned.look(decoded(view.data))
        row, slope = room.edge(view.camera, sight.spot.u_px, "stripe")
        assert np.arctan(sight.border.slope) == pytest.approx(np.arctan(slope), abs=0.15 * DEG)
        assert (sight.border.v_px - row) / np.hypot(1.0, slope) == pytest.approx(0.0, abs=0.6)


def test_without_an_object_there_is_none_under_any_lamp():
    for lamp_k, light in LAMPS:
        room, eyes = Room(WorldParams(lamp_k=lamp_k, light=light, distractors=False)), Eyes(LEARNED)
        assert all(eyes.look(decoded(view.data)).spot is None for view in room.empty_views(10))


@pytest.mark.parametrize("kelvin", [2700, 3300, 5000, 6500])
def test_wiens_law_is_near_the_lamps_of_the_renderer(kelvin):
    blue, green, red = lamp.gains(1.0, kelvin)
    learned = palette.lamp_gain(1 / kelvin - 1 / 4000)
    assert learned / learned[1] == pytest.approx(np.array((red, green, blue)) / green, rel=0.05)


def test_under_the_lamp_that_the_camera_is_balanced_for_nothing_changes():
    assert lamp.gains(1.0, 4000.0) == (1.0, 1.0, 1.0)


def test_a_colour_is_its_own_and_what_was_not_learned_is_told_by_thresholds():
    image = np.full((240, 320, 3), 120, np.uint8)
    image[50:90, 50:90], image[150:158] = OBJECT[::-1], STRIPE[::-1]
    for params in (Params(object_colour=OBJECT, table_colour=STRIPE), Params(object_colour=OBJECT)):
        thing, stripe = palette.Palette(params).masks(image)
        assert (np.count_nonzero(thing), np.count_nonzero(stripe)) == (1600, 8 * 320)
        assert thing[50:90, 50:90].all()
    thing, stripe = palette.Palette(LEARNED).masks(image)
    assert (np.count_nonzero(thing), np.count_nonzero(stripe)) == (1600, 0), "a stripe where lines are looked for"


def test_pointing_gives_the_median_and_a_region_the_regions():
    image = np.zeros((240, 320, 3), np.uint8)
    image[100:120, 100:120] = (45, 115, 22)
    image[110, 110] = 255
    assert pointing.colour(image, pointing.around(110, 110, 320)) == OBJECT
    assert pointing.colour(image, Region(100, 100, 20, 20)) == OBJECT


@pytest.mark.parametrize(
    ("paint", "region", "words"),
    [
        ((45, 115, 22), Region(318, 0, 5, 5), "must lie within the image of 320x240 px"),
        ((45, 115, 22), Region(0, 0, 0, 5), "must lie within"),
        ((40, 253, 40), Region(0, 0, 5, 5), "overexposed"),
        ((120, 120, 130), Region(0, 0, 5, 5), "grey"),
    ],
)
def test_what_can_not_be_learned_says_why(paint, region, words):
    with pytest.raises(UnclearError, match=words):
        pointing.colour(np.full((240, 320, 3), paint, np.uint8), region)


def test_two_colours_in_one_region_and_two_of_a_kind_are_refused():
    image = np.full((240, 320, 3), (45, 115, 22), np.uint8)
    image[:, 160:] = (22, 122, 242)
    with pytest.raises(UnclearError, match="more than one colour"):
        pointing.colour(image, Region(140, 100, 40, 20))
    pointing.check_apart(OBJECT, STRIPE)
    with pytest.raises(UnclearError, match="looks like the object's"):
        pointing.check_apart(OBJECT, (40.0, 130.0, 60.0))
