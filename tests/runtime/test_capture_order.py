"""Time does not run backwards on a port."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.capture_order import CaptureOrder
from runtime.clock import LOG_SKEW_NS, SECOND_NS
from runtime.wire import Refused, Stamp


def test_time_that_runs_backwards_in_a_run_is_refused_and_the_next_message_is_not():
    order = CaptureOrder()
    order.check("percept", Stamp(1, 0, 100 * SECOND_NS))
    with pytest.raises(Refused, match=r"time runs backwards by 99\.000 s in run 0000000000000001"):
        order.check("percept", Stamp(1, 1, SECOND_NS))
    order.check("percept", Stamp(1, 2, 100 * SECOND_NS + 1))


def test_a_stop_between_two_frames_is_newer_than_the_frames_that_are_answered_after_it():
    order = CaptureOrder()
    for capture_ns in (10 * SECOND_NS, 10 * SECOND_NS - LOG_SKEW_NS, 11 * SECOND_NS):
        order.check("applied", Stamp(1, 0, capture_ns))


def test_a_new_run_begins_where_it_likes_and_ports_do_not_touch_one_another():
    order = CaptureOrder()
    order.check("percept", Stamp(1, 0, 100 * SECOND_NS))
    order.check("applied", Stamp(1, 0, 0))
    order.check("percept", Stamp(2, 0, 0))


@given(st.lists(st.integers(0, 2**62 - 1), max_size=30))
def test_what_is_let_through_never_lags_by_more_than_the_skew(times):
    order, newest = CaptureOrder(), 0
    for time_ns in times:
        try:
            order.check("port", Stamp(1, 0, time_ns))
        except Refused:
            assert time_ns < newest - LOG_SKEW_NS
            continue
        assert time_ns >= newest - LOG_SKEW_NS
        newest = max(newest, time_ns)
