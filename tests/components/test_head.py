import math

from hypothesis import given
from hypothesis import strategies as st

from components.head.component import Head
from components.head.ports import Params
from runtime.contract import STOP, Event
from schemas.head_pb2 import HeadCommand, HeadState

ANY = st.floats(allow_nan=True, allow_infinity=True)
DEG = math.pi / 180


def aimed(head, capture_ns, *numbers):
    return head.handle(Event(capture_ns, "aim", HeadCommand(**dict(zip(NAMES, numbers, strict=True))), capture_ns))


NAMES = ("pan_rad", "tilt_rad", "pan_rate_radps", "tilt_rate_radps")


def values(command):
    return tuple(getattr(command, name) for name in NAMES)


def test_a_possible_aim_passes_unchanged():
    (output,) = aimed(Head(Params(), 0), 1, 0.5, 0.3, 0.2, -0.1)
    assert output.port == "actuate"
    assert values(output.message) == (0.5, 0.3, 0.2, -0.1)


def test_an_impossible_aim_is_clamped_to_the_limits_of_a_vc_c4():
    (high,) = aimed(Head(Params(), 0), 1, 9.0, 9.0, 9.0, 9.0)
    (low,) = aimed(Head(Params(), 0), 1, -9.0, -9.0, -9.0, -9.0)
    assert values(high.message) == (100 * DEG, 90 * DEG, 90 * DEG, 622 * 0.1125 * DEG)
    assert values(low.message) == (-100 * DEG, 0.0, -90 * DEG, -622 * 0.1125 * DEG)


def test_an_aim_that_is_no_number_holds_where_the_head_was_last_read():
    head = Head(Params(), 0)
    aimed(head, 1, 0.5, 0.3, 0.2, 0.0)
    head.handle(Event(2, "device", HeadState(pan_rad=0.52, tilt_rad=0.31), 2))
    (output,) = aimed(head, 2, math.nan, 0.3, 0.0, 0.0)
    assert values(output.message) == (0.52, 0.31, 0.0, 0.0)


def test_an_aim_that_is_no_number_holds_where_the_head_was_last_told_to_be():
    head = Head(Params(), 0)
    aimed(head, 1, 0.5, 0.3, 0.2, 0.0)
    (output,) = aimed(head, 2, 0.5, 0.3, math.inf, 0.0)
    assert values(output.message) == (0.5, 0.3, 0.0, 0.0)


def test_encoders_pass_and_unreadable_ones_become_nan():
    head = Head(Params(), 0)
    (good,) = head.handle(Event(1, "device", HeadState(pan_rad=0.1, tilt_rad=0.2), 1))
    (bad,) = head.handle(Event(2, "device", HeadState(pan_rad=1e9, tilt_rad=0.2), 2))
    assert (good.message.pan_rad, good.message.tilt_rad) == (0.1, 0.2)
    assert math.isnan(bad.message.pan_rad)
    assert math.isnan(bad.message.tilt_rad)


def test_a_frame_is_answered_once():
    head = Head(Params(), 0)
    assert len(aimed(head, 1, 0.0, 0.0, 0.0, 0.0)) == 1
    assert aimed(head, 1, 0.0, 0.0, 0.0, 0.0) == ()
    assert head.handle(Event(5, STOP, None, 5)) == ()


@given(st.lists(st.tuples(st.sampled_from(["aim", "device"]), ANY, ANY, ANY, ANY), max_size=12))
def test_whatever_comes_every_new_frame_gets_one_command_within_the_limits(events):
    head, params = Head(Params(), 0), Params()
    for capture_ns, (port, *numbers) in enumerate(events, start=1):
        if port == "device":
            state = HeadState(pan_rad=numbers[0], tilt_rad=numbers[1])
            assert len(head.handle(Event(capture_ns, port, state, capture_ns))) == 1
            continue
        (output,) = aimed(head, capture_ns, *numbers)
        pan, tilt, pan_rate, tilt_rate = values(output.message)
        assert abs(pan) <= params.pan_limit_rad
        assert params.tilt_low_rad <= tilt <= params.tilt_high_rad
        assert abs(pan_rate) <= params.pan_rate_radps
        assert abs(tilt_rate) <= params.tilt_rate_radps
