import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.tracker.component import Tracker
from components.tracker.focal import NonsenseError, Sample, fit
from components.tracker.gaze import direction
from components.tracker.ports import Params
from tests.components.tracking_world import World

DEG = math.pi / 180


def samples_of(focal, bearing=0.1, depression=0.4, turns=((0, 0), (4, 0), (-4, 0), (0, 4), (0, -4))):
    """What a perfect camera sees of a direction, the head turned by these degrees about it."""
    samples = []
    for pan_deg, tilt_deg in turns:
        pan, tilt = bearing + pan_deg * DEG, depression + tilt_deg * DEG
        right = -math.cos(depression) * math.sin(bearing - pan)
        level = math.cos(depression) * math.cos(bearing - pan)
        ahead = level * math.cos(tilt) + math.sin(depression) * math.sin(tilt)
        down = math.sin(depression) * math.cos(tilt) - level * math.sin(tilt)
        samples.append(Sample(pan, tilt, focal * right / ahead, focal * down / ahead))
    return samples


@given(st.floats(100.0, 2000.0), st.floats(-1.5, 1.5), st.floats(0.1, 1.2))
def test_perfect_samples_give_the_focal_length(focal, bearing, depression):
    samples = samples_of(focal, bearing, depression)
    assert direction(samples[1].u_px, samples[1].v_px, samples[1].pan_rad, samples[1].tilt_rad, focal)[0] == (
        pytest.approx(bearing, abs=1e-9)
    )
    assert fit(samples, 2.0) == pytest.approx(focal, rel=1e-6)


def test_an_axis_that_runs_the_wrong_way_is_nonsense():
    for sample in (mirrored := samples_of(364.0)):
        sample.pan_rad = 0.2 - sample.pan_rad
    with pytest.raises(NonsenseError, match="pan runs the wrong way"):
        fit(mirrored, 2.0)


def test_an_axis_that_does_not_turn_is_nonsense():
    with pytest.raises(NonsenseError, match="tilt did not turn"):
        fit(samples_of(364.0, turns=((0, 0), (4, 0), (-4, 0))), 2.0)


def test_axes_that_disagree_are_nonsense():
    for sample in (samples := samples_of(364.0)):
        sample.v_px *= 1.6
    with pytest.raises(NonsenseError, match="disagree"):
        fit(samples, 2.0)


@pytest.mark.parametrize("focal", [250.0, 364.0, 728.0])
def test_head_steps_teach_the_focal_length_within_1_5_percent(focal):
    world = World(focal=focal, noise_px=0.5, alpha=0.15)
    percept = world.until(lambda percept: percept.visible, 50)
    assert percept.focal_px == pytest.approx(focal, rel=0.015)


@pytest.mark.parametrize(("alpha", "tilt"), [(0.38, 0.26), (-0.38, 0.5), (0.38, 0.05), (-0.3, 0.02)])
def test_an_object_at_the_edge_of_the_image_does_not_leave_it(alpha, tilt):
    world = World(alpha=alpha, d=1.5, noise_px=0.3, home_tilt_rad=tilt, tilt=tilt)
    percept = world.until(lambda percept: percept.visible, 50)
    assert percept.focal_px == pytest.approx(364.0, rel=0.02)


@pytest.mark.parametrize(("side", "d"), [(1, 0.4), (-1, 0.4), (1, 1.0), (-1, 1.7)])
def test_an_object_cut_off_by_the_border_of_the_image_is_calibrated_after_a_few_attempts(side, d):
    tilt = math.atan2(0.45, d)
    off_rad = math.atan2(162.0, 364.0 * math.cos(tilt))
    world = World(alpha=side * off_rad, d=d, noise_px=0.3, home_tilt_rad=tilt, tilt=tilt)
    percept = world.until(lambda percept: percept.visible, 80)
    assert percept.focal_px == pytest.approx(364.0, rel=0.02)


def test_nothing_is_visible_before_the_head_is_calibrated():
    world = World()
    for _ in range(10):
        _, percept = world.frame()
        assert not percept.visible
        assert percept.focal_px == 0.0


def test_a_head_that_turns_the_wrong_way_never_sees_and_rests_after_a_few_attempts():
    world = World(alpha=0.05)
    world.mirrored_pan = True
    aims = []
    for _ in range(150):
        aim, percept = world.frame()
        assert not percept.visible
        aims.append((aim.pan_rad, aim.tilt_rad))
    assert world.tracker._state.calibration.failures == Params().calibration_attempts
    assert len(set(aims[-50:])) == 1


def test_a_head_that_rests_after_failures_tries_again():
    world = World(alpha=0.05, calibration_pause_s=2.0)
    world.mirrored_pan = True
    for _ in range(60):
        world.frame()
    world.mirrored_pan = False
    world.until(lambda percept: percept.visible, 200)


def test_a_stuck_head_never_sees():
    world = World(alpha=0.05)
    for _ in range(150):
        world.pan, world.tilt = 0.0, 0.3
        _, percept = world.frame()
        assert not percept.visible


def test_an_object_lost_during_the_steps_is_calibrated_when_it_is_back():
    world = World(noise_px=0.3)
    for k in range(150):
        world.hidden = 8 < k < 30
        _, percept = world.frame()
        if percept.visible:
            break
    assert percept.visible
    assert percept.focal_px == pytest.approx(364.0, rel=0.015)


def test_a_blink_during_the_steps_does_not_matter():
    world = World(noise_px=0.3)
    for k in range(60):
        world.hidden = k % 7 == 6
        _, percept = world.frame()
    assert percept.focal_px == pytest.approx(364.0, rel=0.015)
    assert world.tracker._state.calibration.failures == 0


def test_the_head_is_not_calibrated_while_the_robot_moves():
    world = World(d=2.0, alpha=0.1)
    for _ in range(60):
        _, percept = world.frame(omega=0.004)
        assert percept.focal_px == 0.0
    percept = world.until(lambda percept: percept.visible, 60)
    assert percept.focal_px == pytest.approx(364.0, rel=0.015)


def test_the_steps_are_few():
    world = World(noise_px=0.5)
    world.until(lambda percept: percept.visible, 40)


def test_a_fresh_tracker_knows_no_focal_length():
    assert Tracker(Params(), 0)._state.calibration.focal_px == 0.0
