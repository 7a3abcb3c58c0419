"""Driving back on a perfect plant: sign and law of the held bearing, and where the starts come to lie."""

import math

import numpy as np
import pytest

from components.pilot import reverse
from components.pilot.ports import Params
from components.pilot.progress import Start
from components.pilot.rules import Rules
from components.pilot.sight import UNSEEN, Sight
from docking import plant
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import DEG, HEIGHT_M, drive

RULES = Rules.of(Params(), 1)


def sight(beta, alpha, d):
    return Sight(True, beta, alpha, math.atan2(HEIGHT_M, d))


def test_backwards_beta_changes_by_minus_tan_alpha_per_log_of_distance():
    """The law that `held_bearing` inverts, on the plant itself, alpha held by a perfect head of the robot."""
    beta, alpha, d = 0.1, 0.6, 0.5
    pose = plant.pose(beta, alpha, d)
    for _ in range(20_000):
        _, seen, _ = plant.observe(*pose)
        x, y, heading = plant.advance(*pose, -0.1, 0.0, 0.0005)
        pose = (x, y, heading + seen - alpha)
    end_beta, _, end_d = plant.observe(*pose)
    assert end_beta - beta == pytest.approx(-math.tan(alpha) * math.log(end_d / d), abs=2e-3)


@pytest.mark.parametrize(("beta", "target"), [(0.0, 0.5), (0.5, -0.3), (-0.4, -0.4)])
def test_the_held_bearing_ends_at_the_starts_beta(beta, target):
    d, far = 0.5, 1.6
    start = Start(target, 0.0, math.atan2(HEIGHT_M, far))
    bearing = reverse.held_bearing(RULES, sight(beta, 0.0, d), start)
    assert beta - math.tan(bearing) * math.log(far / d) == pytest.approx(target)


def test_a_beta_that_can_not_be_reached_takes_the_limit_of_the_bearing():
    start = Start(1.0, 0.0, math.atan2(HEIGHT_M, 0.6))
    assert reverse.held_bearing(RULES, sight(-1.0, 0.0, 0.5), start) == -RULES.params.reverse_bearing_rad


def test_close_to_the_table_the_robot_does_not_turn_on_the_spot():
    start = Start(0.3, 0.0, 0.3)
    for alpha in (-80 * DEG, 0.0, 80 * DEG):
        assert reverse.back_off(RULES, sight(0.2, alpha, 0.3), start).v_mps == -RULES.params.reverse_speed_mps


def test_a_mirrored_reverse_is_the_mirror_of_the_reverse():
    left = reverse.back_off(RULES, sight(0.4, -0.2, 0.9), Start(-0.1, 0.3, 0.3))
    right = reverse.back_off(RULES, sight(-0.4, 0.2, 0.9), Start(0.1, -0.3, 0.3))
    assert (left.v_mps, left.omega_radps) == (right.v_mps, -right.omega_radps)


@pytest.mark.parametrize("look", [UNSEEN, sight(0.0, 0.0, 0.3), sight(0.0, 0.0, 1.7), sight(0.0, 0.0, 3.0)])
def test_starts_lie_within_the_ranges_and_behind_the_robot(look):
    generator = np.random.default_rng(0)
    task, share = RULES.task, RULES.params.start_share
    for _ in range(200):
        start = reverse.drawn_start(RULES, generator, look)
        assert abs(start.beta_rad) <= share * task.beta_range_rad
        assert abs(start.alpha_rad) <= share * task.alpha_range_rad
        assert task.start_tilt_min_rad - 1e-9 <= start.tilt_rad <= task.start_tilt_max_rad + 1e-9
        if look.visible and look.tilt_rad > task.start_tilt_min_rad:
            assert start.tilt_rad <= look.tilt_rad + 1e-9


def returns(noise_deg, frames=20_000):
    """First frame of every trial but the first, and the seconds that each reverse took."""
    params = Params(controller="rl-lc", train_s=1e9)
    generator = np.random.default_rng(5)
    starts, seconds, began_ns, before = [], [], 0, None
    for s in drive(params, 2, (0.3, 0.2, 1.7), frames, noise_deg=noise_deg, generator=generator):
        if s.trial.mode == Trial.REVERSE != before:
            began_ns = s.time_ns
        if before == Trial.REVERSE != s.trial.mode:
            starts.append((s.beta_rad, s.alpha_rad, s.d_m))
            seconds.append((s.time_ns - began_ns) * 1e-9)
        before = s.trial.mode
    return np.array(starts), np.array(seconds)


@pytest.mark.parametrize("noise_deg", [0.0, 0.5])
def test_the_starts_cover_the_ranges_in_about_ten_seconds_each(noise_deg):
    starts, seconds = returns(noise_deg)
    beta, alpha, d = starts.T
    assert len(starts) >= 90
    assert 5.0 <= np.median(seconds) <= 12.0
    assert seconds.max() <= RULES.params.reverse_timeout_s
    boxes, _, _ = np.histogram2d(beta / DEG, alpha / DEG, bins=4, range=[(-55.25, 55.25), (-68, 68)])
    assert (boxes > 0).all()
    assert boxes.max() <= 4 * len(starts) / 16
    assert d.min() >= 0.9
    assert d.max() <= 2.1
    assert np.histogram(d, bins=4, range=(1.0, 2.0))[0].min() >= 0.1 * len(d)


def test_with_the_object_out_of_view_the_robot_stands_still_and_goes_on_when_it_is_back():
    params = Params(controller="lc", train_s=1e9)
    begun = next(s for s in drive(params, 1, (0.2, 0.1, 1.8), 400) if s.trial.mode == Trial.REVERSE)
    first = begun.time_ns // 125_000_000 + 8
    seen = list(drive(params, 1, (0.2, 0.1, 1.8), 1200, blind=range(first, first + 480)))
    assert seen[first - 1].drive.v_mps < 0.0
    assert all(s.drive.v_mps == 0.0 == s.drive.omega_radps for s in seen[first : first + 480])
    assert all(s.trial.mode == Trial.REVERSE for s in seen[first : first + 480])
    assert seen[-1].trial.number > begun.trial.number
