"""Keys of a terminal and events of a joystick: what they mean, and that no bytes whatever do harm."""

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.teleop.core import Hand, Request
from components.teleop.keys import READINGS, REST, Keys
from components.teleop.ports import Gamepad
from components.teleop.sticks import Sticks


def event(value, kind, number, time_ms=0):
    """A `struct js_event`, written by the kernel's definition."""
    return struct.pack("=IhBB", time_ms, value, kind, number)


AXIS, BUTTON, INITIAL = 2, 1, 0x80
HOLD = event(1, BUTTON, 5)


@pytest.mark.parametrize(
    ("data", "hand"),
    [
        (b"i", Hand(True, 1.0, 0.0)),
        (b"u", Hand(True, 1.0, 1.0)),
        (b"e", Hand(True, 1.0, -1.0)),
        (b"j", Hand(True, 0.0, 1.0)),
        (b"\x1b[A", Hand(True, 1.0, 0.0)),
        (b"\x1bOB", Hand(True, -1.0, 0.0)),
        (b"\x1b[D", Hand(True, 0.0, 1.0)),
        (b" ", Hand(True)),
        (b"p", Hand(request=Request.GIVE)),
        (b"t", REST),
        (b"k", REST),
        (b"\x1b[1;5A", REST),
        (b"\x1b[15~", REST),
        (b"\x00", REST),
    ],
)
def test_a_key_says_what_the_table_says_and_any_other_takes_the_robot_at_rest(data, hand):
    assert Keys().feed(data) == [hand]
    parts = Keys()
    assert [hand for value in data for hand in parts.feed(bytes((value,)))] == [hand], "in parts too"


def test_escape_alone_is_a_key_once_nothing_more_came():
    keys = Keys()
    assert keys.feed(b"\x1b") == []
    assert keys.flush() == [REST]
    assert keys.feed(b"i") == [Hand(True, 1.0, 0.0)]


@given(st.binary(max_size=200), st.integers(1, 50))
def test_any_bytes_are_readings_of_the_table_and_cuts_change_nothing(data, step):
    whole, parts = Keys(), Keys()
    found = whole.feed(data)
    assert [hand for i in range(0, len(data), step) for hand in parts.feed(data[i : i + step])] == found
    assert set(found) <= {*READINGS.values(), REST}
    assert len(whole.flush()) <= 1


@given(st.binary(max_size=64))
def test_keys_after_rubbish_are_understood_again(data):
    """However long an escape sequence pretends to be."""
    assert Keys().feed(data + b"\x1b[" + b";" * 20 + b"iii")[-1] == Hand(True, 1.0, 0.0)


def test_the_stick_forwards_and_left_is_negative_for_the_kernel_and_positive_here():
    sticks = Sticks(Gamepad())
    sticks.feed(HOLD)
    hand = sticks.feed(event(-32767, AXIS, 1) + event(-16384, AXIS, 0))[-1]
    assert hand == Hand(True, 1.0, pytest.approx(0.5, abs=1e-4))
    assert sticks.feed(event(-32768, AXIS, 1))[-1].forward == 1.0


def test_a_stick_in_its_dead_zone_is_in_the_middle():
    assert Sticks(Gamepad()).feed(event(4000, AXIS, 1))[-1].forward == 0.0


def test_the_dead_man_button_must_be_pressed_after_the_opening():
    sticks = Sticks(Gamepad())
    assert not sticks.feed(event(1, BUTTON | INITIAL, 5))[-1].dead_man
    assert sticks.feed(event(0, BUTTON, 5) + HOLD)[-1].dead_man
    sticks.let_go()
    assert not sticks.now().dead_man
    assert not sticks.feed(event(0, BUTTON, 5))[-1].dead_man


def test_requests_are_said_once_when_pressed():
    sticks = Sticks(Gamepad())
    said = [sticks.feed(event(value, BUTTON, 7))[-1].request for value in (1, 0)]
    assert said == [Request.TAKE, Request.NOTHING]
    assert sticks.now().request == Request.NOTHING


@given(st.binary(max_size=400), st.integers(1, 50))
def test_any_events_are_bounded_readings_and_cuts_change_nothing(data, step):
    whole, parts = Sticks(Gamepad()), Sticks(Gamepad())
    found = whole.feed(data)
    assert [hand for i in range(0, len(data), step) for hand in parts.feed(data[i : i + step])] == found
    assert len(found) == len(data) // 8
    assert all(abs(hand.forward) <= 1.0 and abs(hand.left) <= 1.0 for hand in found)
