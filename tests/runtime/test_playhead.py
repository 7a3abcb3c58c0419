"""When a moment of a log is due."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.playhead import Playhead

S = 1_000_000_000


@given(rate=st.floats(0.1, 100), gaps=st.lists(st.integers(0, 5 * S), min_size=1, max_size=20))
def test_messages_are_due_at_their_distance_divided_by_the_rate(rate, gaps):
    head = Playhead(rate)
    wall_ns, log_ns = 7 * S, 3 * S
    assert head.wait_ns(log_ns, wall_ns) == 0
    for gap_ns in gaps:
        log_ns += gap_ns
        wait_ns = head.wait_ns(log_ns, wall_ns)
        wall_ns += wait_ns
        assert wall_ns - 7 * S == pytest.approx((log_ns - 3 * S) / rate, abs=2)


def test_as_fast_as_possible_never_waits():
    head = Playhead(0.0)
    assert [head.wait_ns(time_ns, 0) for time_ns in (0, S, 1000 * S)] == [0, 0, 0]


def test_paused_waits_until_told_and_goes_on_from_there_without_a_jump():
    head = Playhead(1.0)
    assert head.wait_ns(0, 0) == 0
    head.toggle()
    assert head.wait_ns(S, 50 * S) is None
    head.toggle()
    assert head.wait_ns(S, 60 * S) == 0
    assert head.wait_ns(2 * S, 60 * S) == S


def test_a_step_lets_one_message_pass_and_stands_still():
    head = Playhead(1.0, paused=True)
    head.step()
    assert head.wait_ns(S, 0) == 0
    head.passed(S)
    assert head.wait_ns(2 * S, 0) is None
    assert (head.time_ns, head.paused) == (S, True)


def test_a_step_while_playing_pauses_first():
    head = Playhead(1.0)
    head.step()
    assert head.paused
    assert head.wait_ns(S, 0) == 0


def test_who_was_held_back_is_not_made_to_catch_up_but_a_little_lateness_is():
    head = Playhead(1.0)
    head.wait_ns(0, 0)
    assert head.wait_ns(S, S + S // 20) == 0
    assert head.wait_ns(2 * S, S + S // 20) == S - S // 20
    assert head.wait_ns(2 * S, 10 * S) == 0
    assert head.wait_ns(3 * S, 10 * S) == S
