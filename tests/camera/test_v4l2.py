"""A V4L2 camera through OpenCV's own backend, with a driver that the tests preload (fake_v4l2.py)."""

import contextlib
import json
import os
import subprocess
import sys
import threading
import time

import pytest

from components.camera.header import announced
from tests.camera.fake_v4l2 import Lens, environment
from tests.camera.pictures import jpeg

DEADLINE_S = 60.0
EXPOSURE_AUTO, EXPOSURE, WB_AUTO, WB_TEMPERATURE = 10094849, 10094850, 9963788, 9963802
"""The kernel's numbers of the controls."""


class Camera:
    """The device in a process with the preloaded driver."""

    def __init__(self, folder, lens, table=(), **more):
        words = {"port": str(lens.path), "hz": 100.0, **dict(table)}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.camera.reads", json.dumps(words)],
            env={**os.environ, **environment(lens.path, FAKE_V4L2_LOG=str(folder / "log"), **more)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        self._timer = threading.Timer(DEADLINE_S, self._process.kill)
        self._timer.start()

    def hears(self, key):
        """The next line with a key, read as JSON; or one of the log that holds it."""
        for line in self._process.stdout:
            if line.startswith("{") and key in (words := json.loads(line)):
                return words
            if not line.startswith("{") and key in line:
                return line
        raise AssertionError(f"the process ended without {key!r}")

    def ends(self):
        self._process.stdin.close()
        self.hears("closed")
        code = self._process.wait(DEADLINE_S)
        self._timer.cancel()
        return code

    def close(self):
        self._timer.cancel()
        self._process.kill()
        self._process.wait()


@pytest.fixture
def lens(tmp_path):
    found = Lens(tmp_path / "video0")
    yield found
    found.close()


@pytest.fixture
def camera_of(tmp_path, lens):
    cameras = []

    def make(*table, **more):
        cameras.append(Camera(tmp_path, lens, *table, **more))
        return cameras[-1]

    yield make
    for camera in cameras:
        camera.close()


@contextlib.contextmanager
def showing(lens, data, time_ns=None):
    """Meanwhile the lens shows a picture again and again; the first after opening is thrown away by OpenCV."""
    done = threading.Event()

    def show():
        while not done.wait(0.03):
            lens.show(data, time_ns)

    thread = threading.Thread(target=show)
    thread.start()
    yield
    done.set()
    thread.join()


def seen(lens, camera, data, time_ns=None, until=None):
    """The first reading with these bytes, once the lens shows them."""
    with showing(lens, data, time_ns):
        while bytes.fromhex((reading := camera.hears("data"))["data"]) != (data if until is None else until):
            pass
    return reading


def test_a_cameras_own_jpegs_come_byte_for_byte_with_the_drivers_time(lens, camera_of, tmp_path):
    camera = camera_of()
    camera.hears("opened")
    taken_ns = time.monotonic_ns()
    first = seen(lens, camera, jpeg(1), taken_ns)
    assert abs(first["time_ns"] - taken_ns) < 5_000_000, "of the exposure, however late it was read"
    broken = seen(lens, camera, jpeg(2)[:500])
    assert broken["time_ns"] > first["time_ns"], "the eyes are the judge, and the log has what there was"
    read_ns = time.monotonic_ns()
    later = seen(lens, camera, jpeg(3), time_ns=1_000_000_000)
    assert read_ns < later["time_ns"] <= time.monotonic_ns(), "a stamp of another clock is not believed"
    assert camera.ends() == 0
    written = dict(map(int, line.split()) for line in (tmp_path / "log").read_text().splitlines())
    assert written == {EXPOSURE_AUTO: 1, EXPOSURE: 100, WB_AUTO: 0, WB_TEMPERATURE: 4000}, "0.01 s in units of 0.1 ms"


def test_an_unplugged_camera_is_opened_again_when_it_is_back(lens, camera_of):
    camera = camera_of()
    camera.hears("opened")
    seen(lens, camera, jpeg(1))
    lens.unplug()
    camera.hears("shows nothing any more; opening it again")
    camera.hears("can not be opened: No such file or directory")
    lens.plug()
    camera.hears("is open again")
    seen(lens, camera, jpeg(3))
    assert camera.ends() == 0


def test_a_camera_that_hangs_is_told_opened_anew_and_keeps_nobody_from_ending(lens, camera_of):
    camera = camera_of()
    camera.hears("opened")
    seen(lens, camera, jpeg(1))
    camera.hears("shows nothing any more")
    camera.hears("has shown nothing for 2 s")
    seen(lens, camera, jpeg(2))
    assert camera.ends() == 0, "while it hangs again"


def test_an_empty_image_is_left_out_and_an_endless_one_cut_short(lens, camera_of):
    camera = camera_of()
    camera.hears("opened")
    with showing(lens, b""):
        camera.hears("an image was left out: it is empty or cut short")
    seen(lens, camera, bytes(3_000_000), until=bytes(1 << 20))
    seen(lens, camera, jpeg(2))


def test_a_camera_without_jpegs_and_without_a_will_is_encoded_and_told(lens, camera_of):
    camera = camera_of(FAKE_V4L2_YUYV="1", FAKE_V4L2_STUBBORN="1")
    camera.hears("does not keep its exposure and white balance; colours may change with the light")
    with showing(lens, bytes((128, 128)) * (320 * 240)):
        data = bytes.fromhex(camera.hears("data")["data"])
    assert announced(data) == (320, 240)


def test_a_camera_that_does_not_offer_the_size_is_refused_by_name(lens, camera_of):
    camera = camera_of({"width_px": 640, "height_px": 360})
    assert camera.hears("refused")["refused"] == f"{lens.path} must offer 640x360 px; it offers 640x480"


@pytest.mark.parametrize(
    ("port", "words"), [("/nowhere", "No such file or directory"), ("/dev/null", "it is no camera that V4L2 knows")]
)
def test_what_is_no_camera_is_refused_by_name(lens, camera_of, port, words):
    camera = camera_of({"port": port})
    assert camera.hears("refused")["refused"].startswith(f"{port} can not be opened: {words}")
