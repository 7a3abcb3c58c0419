"""The simulated pan-tilt unit: lag, slew, end stops, moving targets."""

import math

import pytest

from components.simulator.head import Head, Target
from components.simulator.params import Params
from docking.angles import DEG

STEP_NS, STEP_S = 15_625_000, 1 / 64


def run(head, seconds, begin_ns=0):
    angles = []
    for step in range(1, round(seconds * 64) + 1):
        head.step(begin_ns + step * STEP_NS, STEP_S)
        angles.append(head.angles_rad)
    return angles


def test_without_a_command_it_stands_at_home():
    assert run(Head(Params()), 1.0)[-1] == (0.0, 15 * DEG)


def test_a_step_is_answered_exponentially():
    """angle(t) = target (1 - exp(-t / lag)) while the slew limit is not met."""
    head = Head(Params(home_tilt_rad=0.0))
    head.follow(Target(0.02, 0.0, 0.0, 0.0, 0))
    pans = [pan for pan, _ in run(head, 0.2)]
    assert pans == pytest.approx([0.02 * (1 - math.exp(-(k + 1) * STEP_S / 0.04)) for k in range(len(pans))])


def test_it_slews_no_faster_than_a_vc_c4():
    head = Head(Params(home_tilt_rad=0.0))
    head.follow(Target(90 * DEG, 80 * DEG, 0.0, 0.0, 0))
    angles = run(head, 0.5)
    assert angles[-1] == pytest.approx((45 * DEG, 35 * DEG), rel=1e-3)


@pytest.mark.parametrize(("pan", "tilt", "reached"), [(200, 150, (100, 90)), (-200, -30, (-100, 0))])
def test_end_stops_hold(pan, tilt, reached):
    head = Head(Params())
    head.follow(Target(pan * DEG, tilt * DEG, 0.0, 0.0, 0))
    assert run(head, 5.0)[-1] == pytest.approx((reached[0] * DEG, reached[1] * DEG), abs=1e-6)


def test_a_moving_target_is_followed_with_the_lag_of_a_first_order_system():
    """In the steady state a discrete first-order lag is behind a ramp by rate * step * (1 - share) / share."""
    head = Head(Params(head_hold_s=10.0))
    rate = 10 * DEG
    head.follow(Target(0.0, 15 * DEG, rate, 0.0, 0))
    pan, _ = run(head, 2.0)[-1]
    share = 1 - math.exp(-STEP_S / 0.04)
    assert 2.0 * rate - pan == pytest.approx(rate * STEP_S * (1 - share) / share, rel=1e-3)


def test_rates_are_not_followed_for_ever():
    head = Head(Params())
    head.follow(Target(0.0, 15 * DEG, 10 * DEG, 0.0, 0))
    assert run(head, 5.0)[-1][0] == pytest.approx(10 * DEG * 0.5, abs=1e-6)
    assert head.pan.rate_radps == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("place", range(4))
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_target_that_is_no_number_is_ignored(place, value):
    head = Head(Params())
    head.follow(Target(0.1, 0.2, 0.0, 0.0, 0))
    numbers = [0.5, 0.5, 0.0, 0.0]
    numbers[place] = value
    head.follow(Target(*numbers, 0))
    assert run(head, 1.0)[-1] == pytest.approx((0.1, 0.2), abs=1e-6)


@pytest.mark.parametrize("time_ns", [-(2**63), 2**63 - 1])
def test_a_target_from_an_absurd_time_moves_no_further_than_its_hold(time_ns):
    head = Head(Params())
    head.follow(Target(0.0, 0.2, 0.1, 0.0, time_ns))
    assert abs(run(head, 3.0)[-1][0]) <= 0.1 * 0.5 + 1e-9


def test_without_lag_it_is_there_within_a_step():
    head = Head(Params(head_lag_s=0.0))
    head.follow(Target(0.01, 15 * DEG, 0.0, 0.0, 0))
    assert run(head, STEP_S)[-1][0] == 0.01
