"""The messages that wait for the journal."""

import pytest

from runtime.comparison import Comparison
from runtime.hosted import Sample
from runtime.recording import Logged
from runtime.window import Window


def logged(sequence: int, run: int = 1, payload: bytes = b"x") -> Logged:
    return Logged("a/b", "berth.BaseCommand", payload, run, sequence, 10 * sequence, 10 * sequence)


def window(*messages: Logged) -> Window:
    made = Window()
    for message in messages:
        made.add(message)
    return made


def test_a_message_that_was_skipped_is_passed_over():
    waiting = window(logged(0), logged(1), logged(2))
    assert waiting.take(1, 1) == logged(1)
    assert waiting.take(1, 0) is None
    assert waiting.take(1, 2) == logged(2)


def test_what_is_still_to_come_is_told_from_what_is_lost():
    waiting = window(logged(0), logged(2))
    assert waiting.take(1, 1) is None
    assert waiting.has_passed(1, 1)
    assert waiting.take(1, 3) is None
    assert not waiting.has_passed(1, 3)
    assert waiting.take(2, 0) is None
    assert not waiting.has_passed(2, 0)


def test_a_message_is_handed_out_once():
    waiting = window(logged(0))
    assert waiting.take(1, 0) == logged(0)
    assert waiting.take(1, 0) is None
    assert waiting.has_passed(1, 0)


def test_a_restarted_publisher_begins_anew():
    waiting = window(logged(5), logged(0, run=2))
    assert waiting.take(1, 5) == logged(5)
    assert waiting.take(2, 0) == logged(0, run=2)


def test_a_sequence_is_known_by_its_low_32_bits():
    assert window(logged(3)).take(1, 2**32 + 3) == logged(3)


@pytest.mark.parametrize(("count", "size", "kept"), [(5000, 1, 1024), (40, 8 * 1024 * 1024, 16)])
def test_it_keeps_a_bounded_number_of_messages_and_bytes(count, size, kept):
    payload = bytes(size)
    waiting = window(*(logged(sequence, payload=payload) for sequence in range(count)))
    assert waiting.take(1, count - kept - 1) is None
    assert waiting.has_passed(1, count - kept - 1)
    assert waiting.take(1, count - kept) is not None


def said(sequence: int) -> Sample:
    return Sample("a/b", "berth.BaseCommand", b"", 1, sequence, 10 * sequence)


@pytest.mark.parametrize("to_the_end", [True, False])
def test_a_recorded_output_without_counterpart_differs_only_if_the_run_was_replayed_to_its_end(to_the_end):
    comparison = Comparison(tolerant=False)
    for sequence in (0, 1):
        comparison.record(logged(sequence, payload=b""))
    comparison.say(said(0))
    comparison.finish(to_the_end=to_the_end)
    assert comparison.identical == 1
    assert (comparison.different, comparison.beyond) == ((1, 0) if to_the_end else (0, 1))


@pytest.mark.parametrize("to_the_end", [True, False])
def test_a_new_output_differs_only_if_the_run_was_replayed_to_its_end(to_the_end):
    comparison = Comparison(tolerant=False)
    comparison.record(logged(0, payload=b""))
    comparison.say(said(0))
    comparison.say(said(1))
    comparison.finish(to_the_end=to_the_end)
    assert (comparison.different, comparison.unpaired) == ((1, 0) if to_the_end else (0, 1))


def test_either_side_may_come_first_and_neither_grows_without_bound():
    comparison = Comparison(tolerant=False)
    for sequence in range(10_000):
        comparison.say(said(sequence))
    comparison.record(logged(9_999, payload=b""))
    comparison.finish(to_the_end=True)
    assert comparison.identical == 1
    assert comparison.unpaired == 9_999
