"""The camera's pure parts: which frames are passed on, and what pictures become."""

import cv2
import numpy as np
import pytest

from components.camera import header, picture
from components.camera.pace import Pace
from tests.camera.pictures import jpeg
from tests.camera.pictures import picture as painted

SIZE = (320, 240)


@pytest.mark.parametrize("camera_hz", [8.0, 10.0, 15.0, 25.0, 30.0, 60.0])
def test_a_fast_cameras_frames_are_passed_on_at_the_rate_asked_for(camera_hz):
    pace, chance = Pace(8.0), np.random.default_rng(1)
    times_ns = np.arange(1000) * 1e9 / camera_hz + chance.normal(0.0, 1e5, 1000)
    taken_ns = [time_ns for time_ns in times_ns.astype(int).tolist() if pace.takes(time_ns)]
    assert len(taken_ns) == pytest.approx(1000 * 8.0 / camera_hz, rel=0.01)
    assert np.diff(taken_ns).min() > 0.125e9 - 1.1e9 / camera_hz


def test_a_slow_cameras_frames_are_all_passed_on():
    pace = Pace(8.0)
    assert all(pace.takes(number * 200_000_000) for number in range(100))


def test_after_a_pause_nothing_is_made_up_for():
    pace = Pace(10.0)
    assert pace.takes(0)
    taken = [number for number in range(100) if pace.takes(5_000_000_000 + number * 10_000_000)]
    assert np.diff(taken).tolist() == [10] * 9


def test_no_frame_is_passed_on_twice_nor_an_older_one():
    pace = Pace(1000.0)
    assert [pace.takes(time_ns) for time_ns in (5_000_000, 5_000_000, 4_000_000, 9_000_000)] == [
        True,
        False,
        False,
        True,
    ]


def test_a_jpeg_of_the_right_size_stays_as_it_is():
    assert picture.as_jpeg(jpeg(1), SIZE) == jpeg(1)


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
@pytest.mark.parametrize("size", [(640, 480), (1280, 960), (160, 120)])
def test_other_pictures_are_scaled(suffix, size):
    image = painted(5, size)
    data = picture.as_jpeg(cv2.imencode(suffix, image)[1].tobytes(), SIZE)
    shown = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    assert np.abs(shown.astype(int) - painted(5)).mean() < 2.0
    assert header.is_baseline(data)


def test_a_grey_jpeg_becomes_one_in_colour():
    grey = cv2.imencode(".jpg", painted(5)[..., 0])[1].tobytes()
    assert header.announced(grey) == SIZE
    assert not header.is_baseline(grey)
    assert header.is_baseline(picture.as_jpeg(grey, SIZE))


@pytest.mark.parametrize("found", [(1920, 1080), (1280, 720), (640, 360), (1000, 1000), (768, 576), (4000, 3000)])
def test_a_size_is_proposed_that_has_the_pictures_shape_and_that_the_eyes_take(found):
    width, height = picture.alike(found)
    assert width % 8 == height % 8 == 0
    assert picture.is_alike(found, (width, height))


def test_pictures_are_not_stretched():
    with pytest.raises(header.PictureError, match="must be as its shape"):
        picture.as_jpeg(jpeg(1, (320, 200)), SIZE)


@pytest.mark.parametrize("cut", [0, 1, 2, 3, 10, 21, 100, 160])
def test_a_header_cut_short_is_refused(cut):
    with pytest.raises(header.PictureError):
        header.announced(jpeg(1)[:cut])


def test_a_damaged_picture_is_refused():
    png = cv2.imencode(".png", painted(1, (640, 480)))[1].tobytes()
    with pytest.raises(header.PictureError, match="damaged"):
        picture.as_jpeg(png[:60], SIZE)
