"""Driving back on a perfect plant: sign and law of the held bearing, and where the starts come to lie."""

import math

import numpy as np
import pytest

from components.pilot import reverse
from components.pilot.component import Pilot
from components.pilot.ports import Params
from components.pilot.progress import Start
from components.pilot.rules import Rules
from components.pilot.sight import UNSEEN, Sight
from docking import plant
from docking.task import Task
from schemas.drive_pb2 import Applied
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import DEG, HEIGHT_M, PERIOD_NS, drive, frame, percept, tell

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


def reversing(seconds):
    """Params and the frame in which a first reverse has gone on for so long."""
    params = Params(controller="lc", train_s=1e9)
    begun = next(s for s in drive(params, 1, (0.2, 0.1, 1.8), 400) if s.trial.mode == Trial.REVERSE)
    return params, begun.time_ns // PERIOD_NS + seconds * 8


def test_with_the_object_out_of_view_the_robot_stands_still_and_goes_on_when_it_is_back():
    params, first = reversing(1)
    blind = range(first, first + round(params.lost_s * 8))
    seen = list(drive(params, 1, (0.2, 0.1, 1.8), 800, blind=blind))
    assert seen[first - 1].drive.v_mps < 0.0
    assert all(seen[k].drive.v_mps == 0.0 == seen[k].drive.omega_radps for k in blind)
    assert all(seen[k].trial.mode == Trial.REVERSE for k in blind)
    assert seen[-1].trial.number > seen[first].trial.number


def test_an_object_that_stays_lost_is_searched_for_by_one_turn_on_the_spot_and_then_ends_a_trial_by_name():
    params, first = reversing(3)
    seen = list(drive(params, 1, (0.2, 0.1, 1.8), first + 800, blind=range(first, 10_000)))[first:]
    searching = [s for s in seen if s.trial.controller == "search"]
    turned = sum(s.drive.omega_radps for s in searching) * 0.125
    assert abs(turned) == pytest.approx(2 * math.pi, rel=0.02)
    assert all(s.drive.v_mps == 0.0 for s in seen), "the way is not seen"
    lost = [s for s in seen if s.trial.outcome == Trial.LOST]
    assert lost[0].trial.failure == Trial.OBJECT_LOST
    assert lost[0].trial.number == seen[0].trial.number + 1
    assert (lost[0].time_ns - seen[0].time_ns) * 1e-9 <= params.lost_s + 2 * math.pi / params.search_turn_rate_radps + 1
    assert not any(s.drive.omega_radps for s in seen if s.time_ns > lost[0].time_ns), "one search for each loss"
    assert seen[-1].trial.ended > lost[0].trial.ended, "and so on, at rest, until the training is over"


def test_near_the_table_the_robot_does_not_turn_in_search_of_the_object():
    pilot = Pilot(Params(controller="lc", train_s=1e9), 1)
    said = [frame(pilot, k, percept(0.0, 0.0, Task().goal_tilt_rad, visible=k < 3))[:2] for k in range(400)]
    assert said[2][1].mode == Trial.REVERSE
    assert not any(drive.v_mps or drive.omega_radps for drive, _ in said[3:])
    assert Trial.LOST in {trial.outcome for _, trial in said}


def test_an_object_found_again_in_the_search_is_driven_back_from():
    params, first = reversing(3)
    blind = range(first, first + round((params.lost_s + 5) * 8))
    seen = list(drive(params, 1, (0.2, 0.1, 1.8), first + 600, blind=blind))
    assert seen[blind[-1]].trial.controller == "search"
    after = seen[blind[-1] + 1 :]
    assert Trial.LOST not in {s.trial.outcome for s in after}
    assert after[-1].trial.number > seen[first].trial.number


def hindered(reason, d_m, frames=200):
    """A pilot in its reverse at a distance, told each frame that base has refused. Returns (drive, trial) per frame."""
    params = Params(controller="lc", train_s=1e9)
    pilot = Pilot(params, 1)
    frame(pilot, 0, percept(0.0, 0.0, Task().goal_tilt_rad))
    answers = []
    for k in range(1, frames):
        tell(pilot, "applied", Applied(commander=reason), k)
        answers.append(frame(pilot, k, percept(0.1, 0.3, math.atan2(HEIGHT_M, d_m)))[:2])
    return answers


@pytest.mark.parametrize("reason", ["rear", "rear-bumper", "reverse", "fence"])
def test_where_base_refuses_the_way_back_the_robot_turns_and_the_next_trial_begins_there(reason):
    assert all(said.v_mps <= 0.0 for said, _ in hindered("pilot", 0.8)[:40])
    turns = [said for said, trial in hindered(reason, 0.8)[2:40] if trial.mode == Trial.REVERSE]
    assert turns
    assert all(said.v_mps == 0.0 for said in turns)
    assert any(said.omega_radps for said in turns)


def test_near_the_table_a_refused_reverse_does_not_turn_on_the_spot():
    assert all(said.v_mps < 0.0 for said, trial in hindered("rear", 0.4)[2:40] if trial.mode == Trial.REVERSE)


@pytest.mark.parametrize(
    ("look", "led", "begins"),
    [
        ((0.4, 0.3, 1.4), range(2, 9), True),
        ((0.4, 0.3, 0.5), range(2, 9), False),  # nearer than starts are
        ((0.0, 0.0, 1.4), range(2, 9), False),  # in the goal cell
        ((0.4, 0.3, 1.4), range(9), False),  # he drives on from the trial before
        ((0.4, 0.3, 1.4), (), False),
    ],
)
def test_a_person_who_sets_out_from_afar_begins_a_trial(look, led, begins):
    beta, alpha, d_m = look
    pilot = Pilot(Params(controller="lc", train_s=1e9), 1)
    modes = []
    for k in range(9):
        tilt = Task().goal_tilt_rad if k == 0 else math.atan2(HEIGHT_M, d_m)
        _, trial, _ = frame(pilot, k, percept(0.0, 0.0, tilt) if k == 0 else percept(beta, alpha, tilt))
        tell(pilot, "applied", Applied(v_mps=0.1 * (k in led), commander="teleop"), k)
        modes.append(trial.mode)
    assert modes[1] == Trial.REVERSE
    assert (Trial.APPROACH in modes[2:]) == begins
