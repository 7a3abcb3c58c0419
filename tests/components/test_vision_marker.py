"""A square marker as the object, in rendered rooms and on plain paper."""

import cv2
import numpy as np
import pytest

from benchmarks.scenes import Room, decoded
from components.simulator.params import Params as World
from components.vision.core import Eyes
from components.vision.marker import Detector, Marker
from components.vision.params import DICTIONARIES, Params
from docking.angles import DEG
from report.session import read
from runtime.params import ConfigurationError, build
from tests.recorded_session import record

LARGE = ["simulator.width_px=640", "vision.width_px=640", "vision.height_px=480"]


@pytest.fixture(scope="module")
def room():
    return Room(World(object="marker", marker_id=7, width_px=640))


def eyes(**options):
    return Eyes(Params(object="marker", width_px=640, height_px=480, **{"marker_id": 7, **options}))


def paper(dictionary, number, side_px=80, place=(100, 120)):
    """A grey sheet with a white card with a marker."""
    known = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, DICTIONARIES[dictionary].name))
    sheet = np.full((480, 640, 3), 120, np.uint8)
    left, top = place
    cv2.rectangle(sheet, (left - 15, top - 15), (left + side_px + 14, top + side_px + 14), (230, 230, 230), -1)
    sheet[top : top + side_px, left : left + side_px] = cv2.aruco.generateImageMarker(known, number, side_px)[..., None]
    return sheet


@pytest.mark.parametrize("beta_deg", [-60, -20, 0, 45])
@pytest.mark.parametrize("d_m", [0.4, 0.7, 1.2, 1.9])
def test_the_markers_middle_is_the_projection_of_its_centre(room, beta_deg, d_m):
    camera = room.camera(beta_deg * DEG, d_m, 0.05, 0.03)
    spot = eyes().look(decoded(room.view(camera, 3).data)).spot
    assert spot is not None
    assert spot[:2] == pytest.approx(camera.project(np.zeros((1, 3)))[0], abs=0.6)


def test_the_middle_is_where_the_diagonals_cross_whatever_the_perspective():
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float64)
    warp = np.array(((80.0, 13.0, 100.0), (-9.0, 60.0, 70.0), (0.3, 0.8, 1.0)))

    def seen(points):
        whole = np.column_stack((points, np.ones(len(points)))) @ warp.T
        return whole[:, :2] / whole[:, 2:]

    assert Marker(seen(square)).middle == pytest.approx(seen(np.array([(0.5, 0.5)]))[0])


@pytest.mark.parametrize("edge", ["stripe", "hough"])
def test_the_tables_edge_is_told_beside_a_marker_by_either_method(room, edge):
    errors_rad, views = [], list(room.views(30, seed=4))
    for view in views:
        sight = eyes(edge=edge).look(decoded(view.data))
        if sight.spot is not None and sight.border is not None:
            _, slope = room.edge(view.camera, sight.spot.u_px, edge)
            errors_rad.append(abs(np.arctan(sight.border.slope) - np.arctan(slope)))
    assert len(errors_rad) == len(views)
    assert np.percentile(errors_rad, 95) < 0.2 * DEG


@pytest.mark.parametrize("dictionary", DICTIONARIES)
def test_every_dictionary_is_known_and_another_number_is_not_taken(dictionary):
    last = DICTIONARIES[dictionary].markers - 1
    sheet = paper(dictionary, last)
    spot = Detector(dictionary, last).find(sheet)
    assert spot is not None
    assert spot.middle == pytest.approx((139.5, 159.5), abs=0.6)
    assert spot.pixels == pytest.approx(80 * 80, rel=0.05)
    assert Detector(dictionary, last - 1).find(sheet) is None


def test_of_two_of_one_number_the_larger_is_taken():
    sheet = paper("aruco-4x4", 7)
    sheet[250:450, 300:600] = paper("aruco-4x4", 7, 140, (120, 40))[0:200, 50:350]
    marker = Detector("aruco-4x4", 7).find(sheet)
    assert marker is not None
    assert marker.middle[0] > 300


def test_a_marker_cut_off_by_the_border_is_none_and_green_things_are_none(room):
    assert eyes().look(np.roll(paper("aruco-4x4", 7), -120, axis=1)).spot is None
    can = Room(World(width_px=640))
    assert eyes().look(decoded(can.view(can.camera(0.0, 0.8)).data)).spot is None


def test_a_number_that_the_dictionary_has_not_is_refused_by_name():
    with pytest.raises(ConfigurationError, match="marker_id must be below 50, as many as aruco-4x4 has; got 50"):
        build(Params, {"object": "marker", "marker_id": 50}, "a.toml: vision.params")
    build(
        Params, {"object": "marker", "marker_id": 586, "marker_dictionary": "apriltag-36h11"}, "a.toml: vision.params"
    )


@pytest.mark.xdist_group("session")
def test_the_robot_docks_at_a_marker_and_picks_it_up(tmp_path):
    settings = ["simulator.object=marker", "vision.object=marker", *LARGE, "pilot.train_s=0"]
    file = tmp_path / "marker.mcap"
    record(file, [*settings, "pilot.evaluation_trials=1", "pilot.evaluation_controller=lc"], seed=3)
    (trial,) = read(file).trials
    assert trial.docked
    assert trial.picked
