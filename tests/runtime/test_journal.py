"""The journal of a run."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.journal import Entry, JournalWriter, entries
from schemas.session_pb2 import Journal

EVENTS = st.lists(
    st.tuples(
        st.sampled_from(["view", "tick", "gone:pilot", "stop"]),
        st.integers(0, 2**64 - 1),
        st.integers(0, 2**63),
        st.integers(0, 2**62),
    )
)


@given(EVENTS, st.integers(1, 5))
def test_what_was_written_is_read_through_its_bytes(events, limit):
    writer = JournalWriter(events=limit)
    batches = []
    for event in events:
        writer.add(*event, monotonic_ns=0)
        if writer.is_due(0):
            batches.append(writer.take())
    batches.append(writer.take())
    kept = [Journal.FromString(batch.SerializeToString()) for batch in batches if batch is not None]
    assert all(len(batch.port) <= limit for batch in kept)
    assert list(entries(kept)) == [Entry(number, *event) for number, event in enumerate(events)]


def test_a_batch_is_due_a_tenth_of_a_second_after_its_first_event():
    writer = JournalWriter()
    assert writer.due_ns() is None
    writer.add("view", 1, 0, 0, monotonic_ns=1_000)
    writer.add("view", 1, 1, 0, monotonic_ns=50_000_000)
    assert writer.due_ns() == 100_001_000
    assert not writer.is_due(100_000_999)
    assert writer.is_due(100_001_000)


def test_an_empty_journal_has_nothing_to_give():
    assert JournalWriter().take() is None


def test_a_damaged_batch_is_refused():
    with pytest.raises(ValueError, match="begins at event 7 is damaged"):
        list(entries([Journal(first=7, ports=["view"], port=[0, 1], source_run=[1])]))
