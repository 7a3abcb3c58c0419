"""The recorder as a tap: what it writes, acknowledges and misses."""

import pytest

from components.recorder.component import Recorder
from components.recorder.ports import Params
from runtime.launch import load
from runtime.recording import Recording

FRAME = "foxglove.CompressedImage"


@pytest.fixture
def system(tmp_path):
    return load("launch/sim.toml", recording=tmp_path / "unused.mcap")


@pytest.fixture
def recorder(tmp_path, system):
    made = Recorder(Params(file=str(tmp_path / "a.mcap")), system, "then")
    yield made
    made.close()


def hear(recorder, sequence, *, key="vision/view", schema="berth.View", run=7):
    return recorder.message(key, schema, b"", run, sequence, sequence * 10, sequence * 10 + 1)


def said(outputs):
    return [(output.port, output.message) for output in outputs]


def test_a_hole_is_told_with_its_place_and_size(recorder):
    assert [hear(recorder, sequence) for sequence in (3, 4)] == [(), ()]  # it may begin anywhere
    ((port, gap),) = said(hear(recorder, 9))
    assert port == "gap"
    assert (gap.key, gap.run, gap.first_missing, gap.count) == ("vision/view", 7, 5, 4)
    assert hear(recorder, 10) == ()


def test_runs_and_keys_are_counted_apart(recorder):
    for options in ({}, {"run": 8}, {"key": "head/state"}):
        assert hear(recorder, 0, **options) == ()
        assert hear(recorder, 1, **options) == ()


def test_a_frame_is_acknowledged_with_its_capture_time_and_all_counts_so_far(recorder):
    hear(recorder, 0)
    hear(recorder, 2)
    (output,) = hear(recorder, 5, key="camera/image", schema=FRAME)
    assert (output.port, output.capture_ns) == ("ack", 50)
    assert (output.message.messages, output.message.lost) == (3, 1)


@pytest.mark.parametrize(("flush_s", "ticks"), [(0.5, 5), (0.1, 1), (1.0, 10), (0.01, 1)])
def test_what_was_heard_is_on_disk_after_as_many_ticks_as_flush_s_has_tenths(tmp_path, system, flush_s, ticks):
    file = tmp_path / "b.mcap"
    recorder = Recorder(Params(file=str(file), flush_s=flush_s), system, "then")
    hear(recorder, 0)
    for _ in range(ticks - 1):
        recorder.tick(0)
        assert list(Recording(file).messages()) == []
    recorder.tick(0)
    assert [logged.sequence for logged in Recording(file).messages()] == [0]
    recorder.close()


def test_the_last_acknowledgement_counts_everything_and_the_file_is_whole(tmp_path, recorder):
    for sequence in range(5):
        hear(recorder, sequence)
    ((port, ack),) = said(recorder.close())
    assert (port, ack.messages, ack.lost) == ("ack", 5, 0)
    assert Recording(tmp_path / "a.mcap").whole()
