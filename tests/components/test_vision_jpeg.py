"""Hostile and broken JPEGs: refused with words, before memory is spent on them."""

import contextlib

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.vision import jpeg


def picture(height=240, width=320, *options):
    image = np.random.default_rng(1).integers(60, 200, (height // 8, width // 8, 3), np.uint8)
    image = cv2.resize(image, (width, height), interpolation=cv2.INTER_CUBIC)
    return cv2.imencode(".jpg", image, options)[1].tobytes()


GOOD = picture()
FRAME = GOOD.index(b"\xff\xc0")
SCAN = GOOD.index(b"\xff\xda")


def changed(at, new, data=GOOD):
    return data[:at] + new + data[at + len(new) :]


def refusal(data, size=(320, 240)):
    with pytest.raises(jpeg.JpegError) as caught:
        jpeg.decode(data, *size)
    return str(caught.value)


def test_a_good_image_is_decoded_as_opencv_does():
    reference = cv2.imdecode(np.frombuffer(GOOD, np.uint8), cv2.IMREAD_COLOR)
    assert (jpeg.decode(GOOD, 320, 240) == reference).all()


@pytest.mark.parametrize("size", [(65535, 65535), (0, 0), (640, 480), (320, 0)])
def test_a_header_of_another_size_is_refused_before_decoding(size, monkeypatch):
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("decoded"))
    width, height = size
    bomb = changed(FRAME + 5, height.to_bytes(2, "big") + width.to_bytes(2, "big"))
    assert refusal(bomb) == f"the image is {width}x{height} px; expected 320x240"


def test_a_wrong_size_is_named():
    assert refusal(picture(48, 64)) == "the image is 64x48 px; expected 320x240"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "not a JPEG"),
        (b"hello", "not a JPEG"),
        (b"\x89PNG\r\n\x1a\n" + bytes(99), "not a JPEG"),
        (b"\xff\xd8", "cut short"),
        (b"\xff\xd8\xff\xd9", "cut short"),
        (GOOD[:FRAME], "cut short"),
        (GOOD[: FRAME + 8], "cut short"),
        (GOOD[:SCAN], "cut short"),
        (GOOD[: len(GOOD) // 2], "damaged or cut short"),
        (GOOD[:FRAME] + GOOD[SCAN:], "no frame header"),
        (b"\xff\xd8" + b"\xff\xe0\x00\x02" * 1000, "no scan"),
        (changed(FRAME + 2, b"\x00\x01"), "damaged"),
        (changed(SCAN + 200, b"\xff\xc4"), "marker inside the scan"),
        (bytes(5_000_000), "5000000 bytes"),
    ],
)
def test_what_is_no_jpeg_is_refused_in_words(data, words):
    assert words in refusal(data)


def test_progressive_and_grey_images_are_refused():
    assert "baseline" in refusal(picture(240, 320, cv2.IMWRITE_JPEG_PROGRESSIVE, 1))
    grey = cv2.imencode(".jpg", np.arange(240 * 320, dtype=np.uint8).reshape(240, 320))[1].tobytes()
    assert "colour" in refusal(grey)


@pytest.mark.parametrize("sizes", [(b"\xff\xff\xff\xff", b"\x00\xf0\x01\x40"), (b"\x00\xf0\x01\x40",) * 2])
def test_a_second_frame_header_does_not_smuggle_another_size_in(sizes):
    frames = [changed(5, size, GOOD[FRAME : FRAME + 19]) for size in sizes]
    assert "two frame headers" in refusal(GOOD[:FRAME] + b"".join(frames) + GOOD[FRAME + 19 :])


def test_missing_data_is_told_and_not_shown_as_an_image(capfd):
    """The scan ends early but with its end marker: libjpeg fills the rest with grey."""
    assert "one colour" in refusal(GOOD[: SCAN + 400] + b"\xff\xd9")
    capfd.readouterr()


def test_broken_headers_never_reach_the_terminal(capfd):
    for data in (b"", GOOD[:50], GOOD[:SCAN], changed(SCAN + 200, b"\xff\xc4"), b"\x89PNG\r\n\x1a\n" + bytes(99)):
        refusal(data)
    assert capfd.readouterr() == ("", "")


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(st.integers(0, len(GOOD) - 1), st.integers(0, 255)), max_size=8))
def test_changed_bytes_give_an_image_of_the_size_or_a_refusal(changes):
    data = bytearray(GOOD)
    for at, value in changes:
        data[at] = value
    with contextlib.suppress(jpeg.JpegError):
        assert jpeg.decode(bytes(data), 320, 240).shape == (240, 320, 3)


@given(st.binary(max_size=300))
def test_any_bytes_after_a_jpegs_first_two_are_refused(data):
    refusal(b"\xff\xd8" + data)
