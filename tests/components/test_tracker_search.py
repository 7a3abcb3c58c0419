import math
from itertools import pairwise

import pytest

from components.tracker.ports import Params
from components.tracker.search import Search
from tests.components.tracking_world import FRAME_NS, World

DEG = math.pi / 180
PARAMS = Params()


def searching(frames, pan=0.0, tilt=0.3, side=1.0):
    """Aims of a search that begins here."""
    search = Search()
    search.watch(pan, tilt, side)
    return [search.aim(k * FRAME_NS, PARAMS) for k in range(frames)]


def test_the_head_first_stays():
    aims = searching(PARAMS.patience_frames, pan=0.4, tilt=0.3)
    assert set(aims) == {(0.4, 0.3, 0.0, 0.0)}


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_then_it_looks_where_the_object_was_heading(side):
    _, _, pan_rate, _ = searching(PARAMS.patience_frames + 2, side=side)[-1]
    assert pan_rate == pytest.approx(side * PARAMS.search_rate_radps)


@pytest.mark.parametrize(("pan", "tilt"), [(0.0, 0.3), (1.6, 0.2), (-1.2, 1.0)])
def test_the_sweep_covers_the_whole_pan_range_at_every_row(pan, tilt):
    aims = searching(400, pan, tilt)
    for row_deg in (15, 33, 51):
        pans = [aim[0] for aim in aims if abs(aim[1] - row_deg * DEG) < 1 * DEG]
        assert min(pans) < -99 * DEG
        assert max(pans) > 99 * DEG


def test_the_search_never_moves_faster_than_its_rate_and_never_leaves_the_range():
    aims = searching(600, pan=1.7, tilt=1.0)
    assert all(abs(aim[0]) <= 100 * DEG + 1e-9 and 0.0 <= aim[1] <= 1.1 for aim in aims)
    fastest = PARAMS.search_rate_radps * 0.125 + 1e-9
    assert all(max(abs(b[0] - a[0]), abs(b[1] - a[1])) <= fastest for a, b in pairwise(aims))


def test_the_sweep_begins_again_at_its_first_row_and_not_where_the_object_was_lost():
    aims = searching(1000, tilt=57 * DEG)
    assert max(aim[1] for aim in aims[150:]) < 51.1 * DEG


def test_the_search_goes_on_for_ever():
    aims = searching(3000)
    assert len({aim[0] for aim in aims[-300:]}) > 50


def test_a_mirrored_search_is_the_mirror_of_the_search():
    left, right = searching(300, pan=0.2, side=1.0), searching(300, pan=-0.2, side=-1.0)
    for a, b in zip(left, right, strict=True):
        assert a == pytest.approx((-b[0], b[1], -b[2], b[3]), abs=1e-9)


@pytest.mark.parametrize("alpha_deg", [-95, -60, 0, 45, 95])
@pytest.mark.parametrize("d", [0.35, 0.8, 2.0])
def test_an_object_anywhere_around_is_found_and_then_seen(alpha_deg, d):
    world = World(beta=0.0, alpha=alpha_deg * DEG, d=d, noise_px=0.3)
    percept = world.until(lambda percept: percept.visible, 400)
    assert percept.pan_rad == pytest.approx(world.truth[1], abs=0.5 * DEG)


def test_an_object_that_jumps_is_found_again_where_it_is():
    world = World(beta=0.0, alpha=0.0, d=0.35, noise_px=0.3)
    world.until(lambda percept: percept.visible, 400)
    world.pose = World(beta=0.3, alpha=-0.4, d=1.8).pose
    world.frame()
    percept = world.until(lambda percept: percept.visible, 60)
    assert percept.pan_rad == pytest.approx(-0.4, abs=0.5 * DEG)
