"""The inbox of a process."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from runtime.inbox import Arrival, Box, Inbox, Notice
from runtime.wire import Stamp


def arrival(box: Box, sequence: int) -> Arrival:
    return Arrival(box, "a/b", "berth.View", b"", Stamp(1, sequence, 0))


def sequences(inbox: Inbox) -> list[int]:
    taken = []
    while (entry := inbox.take(0)) is not None:
        taken.append(entry.stamp.sequence)
    return taken


def test_samples_of_all_ports_come_out_in_their_order_of_arrival():
    inbox = Inbox()
    view, head = inbox.box("view", 8), inbox.box("head", 8)
    for sequence, box in enumerate((view, head, head, view)):
        inbox.put(arrival(box, sequence))
    assert sequences(inbox) == [0, 1, 2, 3]


def test_a_latest_port_keeps_the_newest_and_counts_the_skipped():
    inbox = Inbox()
    box = inbox.box("image", 1, latest=True)
    for sequence in range(5):
        inbox.put(arrival(box, sequence))
    assert sequences(inbox) == [4]
    assert (box.skipped, box.dropped) == (4, 0)


def test_a_full_queue_keeps_the_oldest_and_counts_the_dropped():
    inbox = Inbox()
    box = inbox.box("view", 3)
    for sequence in range(5):
        inbox.put(arrival(box, sequence))
    assert sequences(inbox) == [0, 1, 2]
    assert (box.skipped, box.dropped) == (0, 2)


def test_a_blocking_queue_loses_nothing_however_slow_its_reader():
    inbox = Inbox()
    box = inbox.box("view", 2, block=True)
    with ThreadPoolExecutor(1) as pool:
        writing = pool.submit(lambda: [inbox.put(arrival(box, sequence)) for sequence in range(200)])
        taken = [inbox.take(5.0).stamp.sequence for _ in range(200)]
        writing.result(timeout=5)
    assert taken == list(range(200))
    assert box.dropped == 0


def test_a_blocking_queue_does_not_block_for_ever():
    box = Box("view", 1, latest=False, block=True)
    assert box.put(arrival(box, 0))
    assert not box.put(arrival(box, 1), block_s=0.01)
    assert box.dropped == 1


def test_shutting_lets_a_blocked_writer_go():
    inbox = Inbox()
    box = inbox.box("view", 1, block=True)
    inbox.put(arrival(box, 0))
    with ThreadPoolExecutor(1) as pool:
        writing = pool.submit(inbox.put, arrival(box, 1))
        inbox.shut()
        writing.result(timeout=5)
    assert sequences(inbox) == [0]


def test_samples_and_a_notice_keep_their_order():
    inbox = Inbox()
    box = inbox.box("view", 8)
    inbox.put(arrival(box, 0))
    inbox.notify(Notice("gone", "pilot"))
    assert isinstance(inbox.take(0), Arrival)
    assert inbox.take(0) == Notice("gone", "pilot")
    assert inbox.take(0) is None


@pytest.mark.parametrize("latest", [False, True])
def test_many_writers_lose_nothing_that_is_not_counted(latest):
    inbox = Inbox()
    box = inbox.box("view", 1 if latest else 10_000, latest=latest)
    with ThreadPoolExecutor(4) as pool:
        writers = [pool.submit(lambda: [inbox.put(arrival(box, n)) for n in range(500)]) for _ in range(4)]
        taken = 0
        while not all(writer.done() for writer in writers):
            taken += inbox.take(0.001) is not None
    taken += len(sequences(inbox))
    assert taken + box.skipped + box.dropped == 2000
