"""What a component was handed, in whose order."""

import pytest

from runtime.handed_over import handed_over
from runtime.recorded_system import recorded_component
from runtime.recording import Recording
from schemas.session_pb2 import Journal
from tests.runtime.offline import FRAMES, rewritten, small_session, without


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    return small_session(tmp_path_factory.mktemp("small"))


def read(file, *others):
    _, spec = recorded_component(Recording(file), "fickle")
    return handed_over(Recording(file), spec, others)


def edited(session, tmp_path, edit):
    def change(topic, message):
        if topic != "fickle/journal":
            return message
        batch = Journal.FromString(message.payload)
        edit(batch)
        return message._replace(payload=batch.SerializeToString())

    return read(rewritten(session, tmp_path / "edited.mcap", change))


def sequences(found) -> list[int]:
    return [logged.sequence for _, logged in found.inputs]


def test_the_journal_s_order_counts_not_the_file_s(session, tmp_path):
    def swap(batch):
        column = batch.source_sequence
        column[3], column[4] = column[4], column[3]

    found = edited(session, tmp_path, swap)
    assert sequences(found) == [0, 1, 2, 4, 3, *range(5, FRAMES)]
    assert found.order == "journal"


def test_a_message_that_was_not_handed_over_is_left_out(session, tmp_path):
    def skip(batch):
        for column in (batch.port, batch.source_run, batch.source_sequence, batch.time_delta_ns):
            del column[5]

    assert sequences(edited(session, tmp_path, skip)) == [*range(5), *range(6, FRAMES)]


def test_a_hole_in_the_journal_leaves_the_order_of_the_file(session, tmp_path):
    def begin_late(batch):
        batch.first += 2

    found = edited(session, tmp_path, begin_late)
    assert sequences(found) == list(range(FRAMES))
    assert found.order == "file (event 0 of the journal is missing)"


def test_a_missing_message_leaves_the_order_of_the_file(session, tmp_path):
    found = read(rewritten(session, tmp_path / "hole.mcap", without("world/image", sequences=range(7, 8))))
    assert found.order == "file (message 7 on image is missing)"


def test_without_a_journal_the_order_of_the_file_has_to_do(session, tmp_path):
    found = read(rewritten(session, tmp_path / "bare.mcap", without("fickle/journal")))
    assert found.order == "file (no journal)"
    assert sequences(found) == list(range(FRAMES))


def test_further_topics_are_read_along(session):
    assert [logged.topic for logged in read(session, "world/end").others] == ["world/end"]
