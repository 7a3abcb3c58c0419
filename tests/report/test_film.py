"""The film: which frames it shows, and that it is one."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from docking.score import Frame
from report import film
from report.comparison import Comparison
from report.overlay import EDGE, OBJECT, camera_picture
from report.reel import Moment, Reel, read
from report.screenplay import END_S, FIRST_PACE, FPS, cues
from schemas.view_pb2 import View

RECORDINGS = Path(__file__).parents[2] / "recordings"
COMPARISON = Comparison(500, [(0.1, 10.0), (0.4, 50.0)], [(0.1, 5.0), (0.4, 40.0)], [], 99.8)


def moment(index, phase="TRAIN", mode="APPROACH", number=0):
    place = dict.fromkeys(Frame._fields, 0.0)
    words = {"phase": phase, "mode": mode, "number": number, "time_s": index / 8, "controller": "lc", "outcome": "NONE"}
    return Moment(index, Frame(**{**place, **words}), 0)


@pytest.fixture
def reel():
    """40 minutes of training, the robot put somewhere, five trials of evaluation."""
    training = [moment(index) for index in range(19200)]
    evaluation = [moment(20000 + 300 * trial + i, "EVALUATE", "SERVO", trial) for trial in range(5) for i in range(300)]
    return Reel(None, {}, [*training, moment(19500, "EVALUATE", "PLACE"), *evaluation])


def test_a_film_runs_from_the_first_frame_to_the_last_in_less_than_25_seconds(reel):
    script = cues(reel)
    times = [cue.moment.frame.time_s for cue in script]
    assert times == sorted(times)
    assert (script[0].moment, script[-1].moment) == (reel.moments[0], reel.moments[-1])
    assert 15.0 < sum(cue.stands_s for cue in script) < 25.0
    assert script[-1].stands_s == END_S


def test_it_begins_slowly_shows_one_evaluation_trial_nearly_so_and_races_through_the_rest(reel):
    paces = {cue.caption: cue.pace for cue in cues(reel)[:-1]}
    first, lapse, one, rest = paces.values()
    assert first == pytest.approx(FIRST_PACE, rel=0.01)
    assert one < first < rest < lapse


def test_where_the_robot_is_only_put_somewhere_nothing_is_shown(reel):
    assert all(cue.moment.frame.mode != "PLACE" for cue in cues(reel))


def test_in_a_time_lapse_the_cameras_picture_stands_still_for_some_frames(reel):
    lapse = [cue for cue in cues(reel) if cue.caption.startswith("learning")]
    assert len({cue.camera_ns for cue in lapse}) * 4 == pytest.approx(len(lapse), abs=4)
    assert all(cue.camera_ns <= cue.moment.capture_ns for cue in lapse)


def test_a_session_of_evaluation_alone_and_one_of_a_single_frame_have_films_too(reel):
    frozen = Reel(None, {}, [each for each in reel.moments if each.frame.phase == "EVALUATE"])
    assert len(cues(frozen)) > 5 * FPS
    assert [cue.moment for cue in cues(Reel(None, {}, [moment(0)]))] == [moment(0)] * 2
    assert [cue.moment for cue in cues(Reel(None, {}, [moment(0, "FINISHED", "WAIT")]))] == [
        moment(0, "FINISHED", "WAIT")
    ] * 2


def test_the_film_of_a_recording_moves_and_holds_a_picture_for_each_cue(tmp_path):
    session = read(RECORDINGS / "reverse.mcap")
    script = cues(session)[::12]
    told = []
    film.film(session, COMPARISON, script, tmp_path / "film.webp", told.append)
    with Image.open(tmp_path / "film.webp") as made:
        assert (made.n_frames, made.size, made.info["loop"]) == (len(script), film.SIZE_PX, 0)
        pictures = []
        for index in range(made.n_frames):
            made.seek(index)
            pictures.append(np.asarray(made.convert("RGB"), float))
    panels = (slice(60, 390), slice(20, 470)), (slice(60, 390), slice(520, 940)), (slice(460, 660), slice(80, 400))
    for rows, columns in panels:
        assert np.abs(pictures[0][rows, columns] - pictures[-1][rows, columns]).mean() > 0.5
    assert told == sorted(told)
    assert 0.0 <= told[0] < told[-1] < 1.0


def test_what_vision_found_is_drawn_where_it_found_it():
    grey = np.full((240, 320, 3), 90, np.uint8)
    jpeg = _jpeg(grey)
    view = View(object_visible=True, object_u_px=40, object_v_px=-30, object_pixels=1257, edge_visible=True,
                edge_slope=0.1, edge_v_px=60)  # fmt: skip
    picture = camera_picture(jpeg, view, (640, 480))
    circle = (2 * (120 - 30), 2 * (160 + 40 + 20))
    edge = (2 * (120 + 60 - 20), 2 * (160 + 40 - 200 + 0))
    assert tuple(picture[circle]) == OBJECT
    assert tuple(picture[edge[0], edge[1] + 1]) == EDGE
    assert camera_picture(b"no image", view, (640, 480)) is None


def _jpeg(image):
    return cv2.imencode(".jpg", image)[1].tobytes()
