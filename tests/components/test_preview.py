"""Pictures for another host: never more than one under way, as good as the link allows."""

import contextlib

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.preview.component import Preview
from components.preview.picture import PictureError, pixels, smaller
from components.preview.ports import Params
from components.preview.window import FIRST, FULL, Window
from runtime.contract import STOP, Event
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import RecorderAck

MS = 1_000_000
FRAME_NS = 125 * MS
SIZE = (240, 320)


def jpeg(quality=95, size=SIZE):
    noise = np.random.default_rng(3).integers(0, 255, (*size, 3), np.uint8)
    return cv2.imencode(".jpg", cv2.GaussianBlur(noise, (0, 0), 2.0), [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()


PICTURE = jpeg()


def show(preview, ms, data=PICTURE):
    """JPEGs that a frame causes."""
    image = CompressedImage(format="jpeg", data=data)
    return [output.message.data for output in preview.handle(Event(ms * MS, "image", image, ms * MS))]


def acknowledge(preview, frame_ms, ms):
    assert preview.handle(Event(ms * MS, "ack", RecorderAck(), frame_ms * MS)) == ()


def test_a_picture_waits_until_the_last_one_has_arrived():
    preview = Preview(Params(), 0)
    assert len(show(preview, 0)) == 1
    assert show(preview, 125) == []
    acknowledge(preview, 0, 130)
    assert len(show(preview, 250)) == 1


def test_one_that_came_late_or_never_halves_the_quality_and_one_in_time_raises_it_a_step():
    window = Window(delay_ns=150, lost_ns=1000, step=5, least=10)
    assert window.quality == FIRST
    window.sent(1, 0)
    window.acknowledged(1, 150)
    assert window.quality == FIRST + 5
    window.sent(2, 200)
    window.acknowledged(2, 351)
    assert window.quality == (FIRST + 5) // 2
    window.sent(3, 400)
    assert not window.opens(1399)
    assert window.opens(1400)
    assert window.quality == (FIRST + 5) // 4
    window.sent(4, 1400)
    window.acknowledged(3, 1450)
    assert window.quality == (FIRST + 5) // 4, "it was given up"


def test_while_nobody_acknowledges_one_is_sent_every_second_and_none_gets_worse():
    preview = Preview(Params(), 0)
    shown = [(ms, show(preview, ms)) for ms in range(0, 5001, 125)]
    assert [ms for ms, data in shown if data] == [0, 1000, 2000, 3000, 4000, 5000]
    assert {data[0] for _, data in shown if data} == {smaller(PICTURE, FIRST)}


def test_in_lockstep_every_picture_crosses_as_it_is():
    preview = Preview(Params(clock="lockstep"), 0)
    assert [show(preview, ms) for ms in (0, 125, 250)] == [[PICTURE]] * 3


@given(st.lists(st.tuples(st.integers(0, 2000), st.booleans()), max_size=60))
def test_the_quality_stays_in_its_range_whatever_comes_when(story):
    window, now = Window(150, 1000, 5, 10), 0
    for wait, arrives in story:
        now += wait
        if window.opens(now):
            window.sent(now, now)
        if arrives:
            window.acknowledged(now, now + wait)
        assert 10 <= window.quality <= FULL


def crossed(bytes_per_s, seconds=60, frame_ms=125):
    """(bytes that a link of this rate carried, longest time on the way in s, JPEGs): a queue without an end."""
    preview, free_ns, under_way, longest_ns, sent = Preview(Params(), 0), 0, [], 0, []
    for now_ns in range(0, seconds * 1000 * MS, 5 * MS):
        while under_way and under_way[0][1] <= now_ns:
            capture_ns, at_ns = under_way.pop(0)
            preview.handle(Event(now_ns, "ack", RecorderAck(), capture_ns))
            longest_ns = max(longest_ns, at_ns - capture_ns)
        if now_ns % (frame_ms * MS) == 0:
            for data in show(preview, now_ns // MS):
                free_ns = max(free_ns, now_ns) + round(len(data) / bytes_per_s * 1e9)
                under_way.append((now_ns, free_ns))
                sent.append(data)
    return sum(map(len, sent)), longest_ns / 1e9, sent


def test_on_a_wide_link_every_picture_crosses_as_it_is():
    _, longest_s, sent = crossed(100 * 8 * len(PICTURE))
    assert len(sent) == 60 * 8
    assert sent[10:] == [PICTURE] * (60 * 8 - 10)
    assert longest_s < 0.02


@pytest.mark.parametrize("share", [0.5, 0.2, 0.05])
def test_a_narrow_link_is_used_and_never_filled(share):
    rate = share * 8 * len(PICTURE)
    total, longest_s, sent = crossed(rate)
    assert 0.2 * 60 * rate < total <= 60 * rate + len(PICTURE)
    assert longest_s <= len(PICTURE) / rate + 0.01, "nothing waits for another picture"
    assert np.mean([len(data) for data in sent[10:]]) / rate < 0.3, "and each is soon there"


def test_a_smaller_picture_has_the_same_pixels_and_never_more_bytes():
    sizes = [len(smaller(PICTURE, quality)) for quality in (100, 80, 40, 10)]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[0] <= len(PICTURE)
    assert sizes[-1] < len(PICTURE) / 4
    again = cv2.imdecode(np.frombuffer(smaller(PICTURE, 40), np.uint8), cv2.IMREAD_COLOR)
    assert again.shape == (*SIZE, 3)
    assert pixels(smaller(PICTURE, 40)) == pixels(PICTURE) == SIZE[0] * SIZE[1]


@pytest.mark.parametrize("data", [b"", b"none", PICTURE[:100], PICTURE[:2] + b"\0" * 64, b"\xff\xd8" + b"\xff" * 999])
def test_what_is_no_picture_is_refused_and_counted_and_the_next_one_crosses(data):
    with pytest.raises(PictureError):
        smaller(data, 50)
    preview = Preview(Params(), 0)
    show(preview, 0)
    acknowledge(preview, 0, 400)
    assert show(preview, 500, data) == []
    assert preview.refused == 1
    assert len(show(preview, 625)[0]) < len(PICTURE)


def test_a_header_that_announces_too_much_is_not_decoded():
    at = PICTURE.index(b"\xff\xc0")
    huge = PICTURE[: at + 5] + b"\xff\xff\xff\xff" + PICTURE[at + 9 :]
    with pytest.raises(PictureError, match="at most"):
        smaller(huge, 50)


@given(st.binary(max_size=300), st.integers(1, 100))
def test_any_bytes_are_a_picture_or_refused(data, quality):
    with contextlib.suppress(PictureError):
        smaller(b"\xff\xd8" + data, quality)


def test_the_end_says_nothing():
    assert Preview(Params(), 0).handle(Event(0, STOP)) == ()
