"""Video files and image folders as cameras, and what a source of any kind may do to its watcher."""

import time

import cv2
import pytest

from components.camera.devices.folder import ImageFolder
from components.camera.devices.source import BYTES_MAX, EndError, Watched
from components.camera.devices.video import VideoFile
from components.camera.ports import Folder, Video
from runtime.contract import DeviceError
from tests.camera.pictures import jpeg, number_of, picture

DEADLINE_S = 30.0


def readings(device, count, timeout_s=DEADLINE_S):
    """(picture's bytes, monotonic time s) of the next readings; fewer if no more come."""
    found, until_s = [], time.monotonic() + timeout_s
    while len(found) < count and time.monotonic() < until_s:
        reading = device.read(0.02)
        if reading is not None:
            found.append((reading.message.data, time.monotonic() - reading.age_s))
    return found


@pytest.fixture
def album(tmp_path):
    folder = tmp_path / "images"
    folder.mkdir()
    (folder / "a10.jpg").write_bytes(jpeg(3))
    (folder / "a2.jpg").write_bytes(jpeg(2))
    (folder / "a1.png").write_bytes(cv2.imencode(".png", picture(1, (640, 480)))[1].tobytes())
    (folder / "notes.txt").write_text("no picture")
    return folder


def test_a_folder_is_shown_in_the_order_of_its_numbers_again_and_again_at_its_rate(album):
    device = ImageFolder(Folder(port=str(album), hz=50.0))
    found = readings(device, 6)
    device.close()
    assert [number_of(data) for data, _ in found] == [1, 2, 3, 1, 2, 3]
    assert found[1][0] == jpeg(2), "byte for byte, where it is a JPEG of the right size"
    assert found[5][1] - found[0][1] >= 5 / 50.0 - 0.005


def test_a_folder_that_is_not_to_loop_falls_silent_at_its_end(album, capsys):
    device = ImageFolder(Folder(port=str(album), hz=50.0, loop=False))
    assert len(readings(device, 4, 1.0)) == 3
    device.close()
    assert f"camera {album}: has ended" in capsys.readouterr().out


def test_images_that_can_not_be_used_are_left_out_by_name(album, capsys):
    (album / "a3.jpg").write_bytes(jpeg(1, (640, 360)))
    (album / "a4.jpg").write_bytes(b"\xff\xd8 no picture")
    progressive = jpeg(5, flags=(cv2.IMWRITE_JPEG_PROGRESSIVE, 1))
    (album / "a5.jpg").write_bytes(progressive)
    (album / "a6.jpg").mkdir()
    giant = bytearray(cv2.imencode(".png", picture(1))[1].tobytes())
    giant[16:20] = (30_000).to_bytes(4, "big")
    (album / "a7.png").write_bytes(giant)
    device = ImageFolder(Folder(port=str(album), hz=100.0, loop=False))
    found = readings(device, 4)
    device.close()
    assert [number_of(data) for data, _ in found] == [1, 2, 5, 3]
    assert found[2][0] != progressive, "the eyes take baseline JPEGs only"
    told = capsys.readouterr().out
    for words in (
        "a3.jpg: is 640x360 px; width_px and height_px must be as its shape, 384x216",
        "a4.jpg: a JPEG without a usable header",
        "a6.jpg: no file, or too many bytes",
        "a7.png: an absurd size",
    ):
        assert words in told


@pytest.fixture
def film(tmp_path):
    """Two seconds at 20 frames a second."""
    file = tmp_path / "walk.avi"
    writer = cv2.VideoWriter(str(file), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*"MJPG"), 20.0, (640, 480))
    for number in range(10):
        writer.write(picture(number, (640, 480)))
    writer.release()
    return file


def test_a_video_is_shown_at_its_own_speed_and_begins_again(film):
    device = VideoFile(Video(port=str(film), hz=10.0))
    found = readings(device, 7)
    device.close()
    assert [number_of(data) for data, _ in found] == [0, 2, 4, 6, 8, 0, 2]
    assert found[4][1] - found[0][1] == pytest.approx(0.4, abs=0.01)


@pytest.mark.parametrize(
    ("kind", "table", "words"),
    [
        (ImageFolder, Folder(port="/nowhere"), "/nowhere can not be read: No such file"),
        (ImageFolder, Folder(port="/dev"), "/dev must hold images"),
        (VideoFile, Video(port="/dev/zero"), "/dev/zero can not be opened: it is no file"),
        (VideoFile, Video(port=__file__), "can not be used: no video that FFmpeg knows"),
    ],
)
def test_what_is_none_is_refused_by_name(kind, table, words):
    with pytest.raises(DeviceError, match=words):
        kind(table)


def test_a_video_of_another_shape_is_refused_with_a_size_that_would_do(film):
    with pytest.raises(DeviceError, match=r"is 640x480 px; width_px and height_px must be as its shape, 320x240"):
        VideoFile(Video(port=str(film), width_px=640, height_px=360))


def test_a_folder_without_any_image_that_can_be_used_is_refused_with_the_first_reason(album):
    words = "must hold images that can be used; a1.png: is 640x480 px; .* must be as its shape, 320x240"
    with pytest.raises(DeviceError, match=words):
        ImageFolder(Folder(port=str(album), width_px=640, height_px=360))


class Script:
    """A source that does what it is told, frame by frame."""

    def __init__(self, *acts, waits=True):
        self.acts, self.waits = list(acts), waits
        self.closed = 0

    def grab(self):
        act = self.acts.pop(0) if self.acts else EndError()
        if isinstance(act, Exception):
            raise act
        self.data = act
        time.sleep(0.001)
        return time.monotonic_ns()

    def picture(self):
        return self.data

    def close(self):
        self.closed += 1


def test_a_lost_source_is_closed_and_opened_again_and_a_giant_image_left_out(capsys):
    sources = [Script(b"one", DeviceError("is gone")), Script(b"0" * (BYTES_MAX + 1), b"two")]
    waiting = list(sources)
    device = Watched("it", 120.0, lambda: waiting.pop(0))
    device._pace._period_ns = 1
    assert [data for data, _ in readings(device, 2)] == [b"one", b"two"]
    device.close()
    assert [source.closed for source in sources] == [1, 1]
    told = capsys.readouterr().out
    assert f"it has {BYTES_MAX + 1} bytes" in told
    assert "camera it: is gone; opening it again" in told


def test_what_nobody_has_foreseen_is_raised_where_the_device_is_read():
    device = Watched("it", 8.0, lambda: Script(RuntimeError("unforeseen")))
    with pytest.raises(RuntimeError, match="unforeseen"):
        readings(device, 1)
    device.close()


def test_of_the_worlds_frames_only_the_newest_is_read_and_of_a_files_each():
    for waits, expected in ((False, [b"three"]), (True, [b"one", b"two", b"three"])):
        script = Script(b"one", b"two", b"three", waits=waits)
        device = Watched("it", 120.0, lambda script=script: script)
        device._pace._period_ns = 1
        if not waits:  # let it run ahead
            device._thread.start()
            until_s = time.monotonic() + DEADLINE_S
            while script.acts and time.monotonic() < until_s:
                time.sleep(0.01)
            device._thread.join(0.1)
        assert [data for data, _ in readings(device, 3, 0.5)] == expected
        device.close()
