"""The tracker in a small world, and its fold under any order and content of events."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from components.tracker.component import Tracker
from components.tracker.ports import Params
from runtime.contract import STOP, Event
from runtime.params import ConfigurationError
from schemas.drive_pb2 import Applied
from schemas.head_pb2 import HeadState
from schemas.view_pb2 import View
from tests.components.tracking_world import FRAME_NS, World

DEG = math.pi / 180


def calibrated(**world):
    """A world whose tracker sees."""
    world = World(**world)
    world.until(lambda percept: percept.visible, 60)
    return world


def driven(world, frames=160, seed=0):
    """Pixel errors, bearing and beta errors over a drive of +-10 deg/s turns at 0.1 m/s."""
    rng, omega, rows = np.random.default_rng(seed), 10 * DEG, []
    for _ in range(frames):
        beta, alpha, _ = world.truth
        if rng.random() < 0.1:
            omega = -omega
        if abs(alpha) > 1.0:
            omega = math.copysign(omega, alpha)
        error_px = math.hypot(*world.object_px)
        _, percept = world.frame(v=0.1, omega=omega)
        read = math.atan2(percept.slope, math.sin(percept.tilt_rad))
        rows.append((error_px, abs(percept.pan_rad - alpha) / DEG, abs(read - beta) / DEG))
    return np.percentile(np.array(rows), 95, axis=0)


def test_feed_forward_keeps_the_object_within_8_px_where_pd_alone_does_not():
    with_it, *_ = driven(calibrated(noise_px=0.5, d=2.0))
    without, *_ = driven(calibrated(noise_px=0.5, d=2.0, feed_forward=False))
    assert with_it < 5.0
    assert without > 8.0


def test_bearing_and_beta_are_read_within_half_a_degree():
    _, bearing_deg, beta_deg = driven(calibrated(noise_px=0.5, d=2.0))
    assert bearing_deg < 0.3
    assert beta_deg < 0.5


def test_the_slope_as_measured_in_the_image_reads_beta_too_large():
    *_, beta_deg = driven(calibrated(beta=0.7, d=2.0, slope_at_centre=False))
    assert beta_deg > 1.0


@pytest.mark.parametrize("feed_forward", [False, True])
def test_a_step_of_the_object_is_followed_without_overshoot(feed_forward):
    world = calibrated(alpha=0.0, feed_forward=feed_forward)
    x, y, heading = world.pose
    world.pose = (x, y, heading - 0.3)
    errors = []
    for _ in range(12):
        errors.append(world.truth[1] - world.pan)
        world.frame()
    assert errors[0] == pytest.approx(0.3, abs=0.01)
    assert min(errors) > -0.1 * DEG
    assert abs(errors[-1]) < 0.1 * DEG


def test_without_feed_forward_the_aim_has_no_rates():
    world = calibrated(feed_forward=False)
    for _ in range(10):
        aim, _ = world.frame(v=0.1, omega=0.2)
        assert (aim.pan_rate_radps, aim.tilt_rate_radps) == (0.0, 0.0)


def test_with_feed_forward_the_pan_turns_against_the_base():
    world = calibrated(alpha=0.0)
    for _ in range(8):
        aim, _ = world.frame(omega=0.17)
    assert aim.pan_rate_radps == pytest.approx(-0.17, abs=0.005)


@pytest.mark.parametrize("omega", [0.5, -0.5])
def test_the_rates_foresee_what_the_base_does_with_its_last_command(omega):
    world = calibrated(alpha=0.0, beta=0.0)
    world.frame()
    world.frame(omega=omega)
    before = world.truth[1]
    aim, _ = world.frame(omega=omega)
    assert aim.pan_rate_radps * 0.125 == pytest.approx(world.truth[1] - before, rel=0.06)  # the world steps


def test_the_lag_of_the_head_is_led():
    world = calibrated(alpha=0.0, beta=0.0)
    for _ in range(12):
        world.frame(omega=0.17)
    assert abs(world.object_px[0]) < 0.7


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e300])
@pytest.mark.parametrize("name", ["v_mps", "omega_radps"])
def test_absurd_speeds_change_nothing(name, bad):
    one, other = calibrated(), calibrated()
    one.tracker.handle(one.event("applied", Applied(**{name: bad})))
    for _ in range(4):
        assert one.frame(v=0.1) == other.frame(v=0.1)


@pytest.mark.parametrize("name", ["object_u_px", "object_v_px"])
def test_an_object_outside_of_any_image_is_not_seen(name):
    world = calibrated()
    t, view = world.now_ns, world.view()
    setattr(view, name, 1e9)
    world.tracker.handle(Event(t, "view", view, t))
    outputs = world.tracker.handle(Event(t, "head", world.head_state(), t))
    assert not next(output.message.visible for output in outputs if output.port == "percept")


def test_an_object_found_without_its_edge_does_not_count_with_the_slope_of_before():
    world = calibrated()
    world.hidden = True
    for _ in range(10):
        world.frame()
    world.hidden, world.edge_hidden = False, True
    for _ in range(60):
        assert not world.frame()[1].visible


def test_a_lost_object_leaves_the_percept_as_it_was_but_not_visible():
    world = calibrated()
    _, before = world.frame()
    world.hidden = True
    for _ in range(40):
        _, percept = world.frame()
        assert not percept.visible
        assert (percept.slope, percept.pan_rad, percept.tilt_rad) == (before.slope, before.pan_rad, before.tilt_rad)
    world.hidden = False
    found = world.until(lambda percept: percept.visible, 200)
    assert found.pan_rad == pytest.approx(world.truth[1], abs=0.5 * DEG)


def test_a_lost_edge_keeps_the_slope_for_a_few_frames_and_the_object_for_ever():
    world = calibrated(edge_memory_frames=2)
    _, before = world.frame()
    world.edge_hidden = True
    percepts = [world.frame(omega=0.1)[1] for _ in range(20)]
    assert [percept.visible for percept in percepts[:4]] == [True, True, False, False]
    assert all(percept.slope == before.slope for percept in percepts)
    assert percepts[-1].pan_rad == pytest.approx(before.pan_rad - 0.1 * 19 * 0.125, abs=2 * DEG)


def test_encoders_of_other_times_are_interpolated_to_the_exposure():
    world = calibrated()
    tracker, t = world.tracker, world.now_ns
    tracker.handle(Event(t, "head", HeadState(pan_rad=0.1, tilt_rad=0.3), t))
    view = View(object_visible=True, edge_visible=True, edge_v_px=10.0)
    assert tracker.handle(Event(t + 60, "view", view, t + 50)) == ()
    outputs = tracker.handle(Event(t + 100, "head", HeadState(pan_rad=0.3, tilt_rad=0.5), t + 100))
    percept = next(output.message for output in outputs if output.port == "percept")
    assert (percept.pan_rad, percept.tilt_rad) == (pytest.approx(0.2), pytest.approx(0.4))
    assert {output.capture_ns for output in outputs} == {t + 50}
    assert percept.capture_time_ns == t + 50


def test_a_frame_with_unreadable_encoders_is_answered_and_not_visible():
    world = calibrated()
    t = world.now_ns
    world.tracker.handle(Event(t, "view", world.view(), t))
    outputs = world.tracker.handle(Event(t, "head", HeadState(pan_rad=math.nan, tilt_rad=0.2), t))
    said = {output.port: output.message for output in outputs}
    assert not said["percept"].visible
    assert math.isfinite(said["aim"].pan_rad + said["aim"].tilt_rad)


def test_pd_gains_that_overshoot_are_refused():
    with pytest.raises(ConfigurationError, match="pan_gain_p"):
        Params(pan_gain_p=1.0, pan_gain_d=0.1)


def test_the_reference_to_the_exposure_survives_a_silent_base():
    world = World()
    tracker = world.tracker
    for k in range(60):
        t = k * FRAME_NS
        assert tracker.handle(Event(t, "view", world.view(), t)) == ()
        assert len(tracker.handle(Event(t, "head", world.head_state(), t))) == 2


ANY = st.floats(allow_nan=True, allow_infinity=True)
VIEWS = st.builds(
    View,
    object_visible=st.booleans(),
    object_u_px=ANY | st.floats(-100, 100),
    object_v_px=ANY | st.floats(-100, 100),
    edge_visible=st.booleans(),
    edge_slope=ANY | st.floats(-3, 3),
    edge_v_px=ANY | st.floats(-100, 100),
)
HEADS = st.builds(HeadState, pan_rad=ANY | st.floats(-1, 1), tilt_rad=ANY | st.floats(0, 1))
DRIVES = st.builds(Applied, v_mps=ANY | st.floats(-1, 1), omega_radps=ANY | st.floats(-1, 1))
FRAMES = st.lists(st.tuples(VIEWS, HEADS, DRIVES, st.booleans()), max_size=30)


def events_of(frames):
    """Per frame a view and a reading in either order, then what the base applied."""
    for k, (view, head, drive, swapped) in enumerate(frames):
        t = k * FRAME_NS
        pair = [Event(t, "view", view, t), Event(t, "head", head, t)]
        yield from reversed(pair) if swapped else pair
        yield Event(t, "applied", drive, t)
    yield Event(len(frames) * FRAME_NS, STOP, None, len(frames) * FRAME_NS)


def known(focal_px=364.0):
    """A tracker that knows its focal length."""
    tracker = Tracker(Params(), 0)
    tracker._state.calibration.focal_px = focal_px
    return tracker


@settings(max_examples=60)
@given(FRAMES, st.booleans())
def test_whatever_comes_every_frame_gets_one_finite_aim_and_one_percept(frames, calibrated):
    tracker = known() if calibrated else Tracker(Params(), 0)
    outputs = [output for event in events_of(frames) for output in tracker.handle(event)]
    for port in ("aim", "percept"):
        captures = [output.capture_ns for output in outputs if output.port == port]
        assert captures == [k * FRAME_NS for k in range(len(frames))]
    for output in outputs:
        numbers = [value for _, value in output.message.ListFields()]
        assert all(math.isfinite(number) for number in numbers)


@settings(max_examples=30)
@given(FRAMES, st.integers(0, 90))
def test_a_tracker_saved_and_loaded_goes_on_with_the_same_bytes(frames, cut):
    events = list(events_of(frames))
    whole, first = known(), known()
    expected = [answer(whole, event) for event in events]
    got = [answer(first, event) for event in events[:cut]]
    second = Tracker(Params(), 0)
    second.load(first.save())
    assert got + [answer(second, event) for event in events[cut:]] == expected


def answer(tracker, event):
    return [(output.port, output.message.SerializeToString(deterministic=True)) for output in tracker.handle(event)]


def test_a_repeated_frame_is_not_answered_again():
    world = World()
    world.frame()
    events = list(events_of([(View(), HeadState(), Applied(), False)]))
    assert [world.tracker.handle(event) for event in events] == [(), (), (), ()]


def test_images_without_encoders_and_encoders_without_images_are_bounded():
    tracker = Tracker(Params(), 0)
    for k in range(1000):
        tracker.handle(Event(k, "view", View(), k))
    for k in range(2000, 3000):
        tracker.handle(Event(k, "head", HeadState(), k))
    assert len(tracker._state.join.sights) <= 16
    assert len(tracker._state.join.readings) <= 32


@pytest.mark.parametrize("data", [b"", b"{}", b"[1]", b"\xff", b'{"join": 1}', b"[" * 100_000])
def test_a_damaged_state_is_refused_and_changes_nothing(data):
    tracker = known()
    before = tracker.save()
    with pytest.raises(ValueError):  # noqa: PT011  # any text will do
        tracker.load(data)
    assert tracker.save() == before


def test_a_restarted_tracker_sees_at_once():
    world = calibrated()
    world.frame()
    restarted = Tracker(Params(), 0)
    restarted.load(world.tracker.save())
    world.tracker = restarted
    _, percept = world.frame()
    assert percept.visible


def test_the_same_events_give_the_same_bytes():
    def run():
        world = calibrated(noise_px=0.5)
        return [world.frame(v=0.1, omega=0.1)[1].SerializeToString(deterministic=True) for _ in range(20)]

    assert run() == run()


def test_the_aim_does_not_jump_while_the_object_rests():
    world = calibrated()
    aims = [world.frame()[0].pan_rad for _ in range(30)]
    assert max(abs(b - a) for a, b in pairwise(aims[10:])) < 0.05 * DEG
