"""What the simulator connects wrongly, base and head put right: together they are nothing."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.base.component import Base
from components.base.motion import Motion
from components.base.polarity import beams_read, odometry_read, wired
from components.base.ports import Params as BaseParams
from components.head.component import Head
from components.head.ports import Params as HeadParams
from components.simulator.gripper import Action, Gripper
from components.simulator.params import Params as World
from components.simulator.past import Moment, Past
from components.simulator.wiring import Wiring
from docking.pinhole import Mount
from runtime.contract import Event
from runtime.params import ConfigurationError, build
from schemas.drive_pb2 import BaseState, Drive
from schemas.head_pb2 import HeadCommand, HeadState

SCALES = st.sampled_from((-1000.0, -57.3, -1.0, 0.02, 1.0, 57.3))
NUMBERS = st.floats(-5.0, 5.0)
BOOLS = (False, True)


@given(SCALES, SCALES, NUMBERS, NUMBERS, NUMBERS)
def test_odometry_is_read_as_it_is(way, turn, x, y, heading):
    wiring = Wiring(odometry=way, heading=turn)
    params = BaseParams(odometry_scale=1.0 / way, heading_scale=1.0 / turn)
    read = (*wiring.odometry_read(x, y, heading), way * x, turn * heading)
    assert odometry_read(read, params) == pytest.approx((x, y, heading, x, heading))


@given(SCALES, SCALES, NUMBERS, NUMBERS)
def test_the_robot_drives_as_it_is_told(forward, turn, v, omega):
    told = wired(Motion(v, omega), BaseParams(speed_scale=1.0 / forward, turn_scale=1.0 / turn))
    assert (forward * told[0], turn * told[1]) == pytest.approx((v, omega))


@pytest.mark.parametrize(("swapped", "inner", "outer"), list(itertools.product(BOOLS, repeat=3)))
def test_beams_are_read_as_they_are(swapped, inner, outer):
    wiring = Wiring(beams_swapped=swapped, inner_beam_inverted=inner, outer_beam_inverted=outer)
    params = BaseParams(beams_swapped=swapped, inner_beam_inverted=inner, outer_beam_inverted=outer)
    for broken in itertools.product(BOOLS, repeat=2):
        assert beams_read(*wiring.beams(*broken), params) == broken


def test_the_state_is_in_the_robots_axes_and_what_was_applied_is_what_was_meant():
    base = Base(BaseParams(commanders=("pilot",), speed_scale=-1.0, odometry_scale=0.001, lift_reversed=True), 0)
    (state,) = base.handle(Event(1, "device", BaseState(odometry_x_m=1500.0, v_mps=100.0), 1))
    assert (state.message.odometry_x_m, state.message.v_mps) == pytest.approx((1.5, 0.1))
    command, applied = base.handle(Event(2, "pilot", Drive(engaged=True, v_mps=0.1), 2))
    assert (command.message.v_mps, applied.message.v_mps) == (-0.1, 0.1)
    assert command.message.lift_reversed
    assert not command.message.fingers_reversed


def test_a_reading_that_is_no_number_leaves_the_odometry_where_it_was():
    base = Base(BaseParams(odometry_scale=0.001), 0)
    base.handle(Event(1, "device", BaseState(odometry_x_m=1500.0), 1))
    (state,) = base.handle(Event(2, "device", BaseState(odometry_x_m=math.nan), 2))
    assert state.message.odometry_x_m == 1.5


def test_the_head_is_told_and_read_in_its_own_units_within_the_robots_limits():
    head = Head(HeadParams(pan_scale=-57.3, tilt_encoder_scale=-1.0), 0)
    (told,) = head.handle(Event(1, "aim", HeadCommand(pan_rad=9.0, tilt_rad=0.5, pan_rate_radps=0.1), 1))
    assert told.message.pan_rad == pytest.approx(-57.3 * math.radians(100))
    assert (told.message.tilt_rad, told.message.pan_rate_radps) == pytest.approx((0.5, -5.73))
    (state,) = head.handle(Event(1, "device", HeadState(pan_rad=0.2, tilt_rad=-0.3), 1))
    assert (state.message.pan_rad, state.message.tilt_rad) == (0.2, 0.3)


@pytest.mark.parametrize("value", [0.0, math.nan, math.inf, 1001.0])
def test_a_scale_that_is_none_is_refused(value):
    with pytest.raises(ConfigurationError, match=r"head\.pan_scale"):
        build(HeadParams, {"pan_scale": value}, "head")


@pytest.mark.parametrize("action", [Action.LOWER, Action.CLOSE, Action.LIFT, Action.RELEASE])
def test_a_reversed_gripper_that_is_told_so_moves_like_a_right_one(action):
    """The simulator reverses what is wired wrongly and what the command says: twice is not at all."""
    right, reversed_ = Gripper(World()), Gripper(World())
    for gripper in (right, reversed_):
        gripper.lift, gripper.fingers = 0.5, 0.5
    right.command(action, False, False)
    reversed_.command(action, True, True)
    for gripper in (right, reversed_):
        gripper.step(1.0, 0.0, 0.1)
    mirrored = [1.0 - value for value in (reversed_.lift, reversed_.fingers)]
    assert (right.lift, right.fingers) == pytest.approx(mirrored)


def moments(count=32):
    """A head that turns by 1 rad/s, every 1/64 s."""
    for k in range(count):
        time_ns = k * 15_625_000
        pan_rad = time_ns * 1e-9
        camera = Mount().camera((0.0, 0.0, 0.0), pan_rad, 0.0, 364.0)
        yield Moment(time_ns, pan_rad, 0.0, camera, None, None)


def test_what_lags_shows_exactly_the_world_of_then():
    past = Past(Wiring(camera_latency_s=0.1, encoder_latency_s=0.03), 64)
    for moment in moments():
        past.add(moment)
        now = moment
    then_s = now.time_ns * 1e-9
    assert past.seen(now).camera.yaw_rad == pytest.approx(then_s - 0.1)
    assert past.read(now)[0] == pytest.approx(then_s - 0.03)


def test_what_does_not_lag_shows_the_world_of_now():
    past = Past(Wiring(), 64)
    (*_, now) = moments()
    assert not past.is_kept
    assert past.seen(now) is now
