"""A robot whose own watchdog is slow approaches the table so slowly that it would stop before it by itself."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.pilot.component import Pilot
from components.pilot.leash import free_way_m, leashed
from components.pilot.ports import Params
from components.pilot.progress import Wish
from components.pilot.rules import Rules
from components.pilot.sight import UNSEEN, sight_of
from docking.angles import DEG
from runtime.contract import Event
from schemas.drive_pb2 import BaseState
from schemas.percept_pb2 import Percept

RULES = Rules.of(Params(), 1)
HEIGHT_M, SINK_M, ROOM_M = 0.45, 0.45 / math.tan(58.5 * DEG), 0.04
angles = st.floats(-1.2, 1.2)


def at(d_m, beta_rad=0.0, alpha_rad=0.0):
    tilt_rad = math.atan2(HEIGHT_M, d_m)
    return sight_of(RULES.task, True, math.tan(beta_rad) * math.sin(tilt_rad), alpha_rad, tilt_rad)


@pytest.mark.parametrize("d_m", [0.29, 0.4, 1.0, 2.0])
def test_the_free_way_is_what_lies_between_the_gripper_and_the_table(d_m):
    assert free_way_m(RULES, at(d_m)) == pytest.approx(d_m - SINK_M + ROOM_M)
    assert free_way_m(RULES, at(d_m, 40 * DEG)) == pytest.approx(d_m * math.cos(40 * DEG) - SINK_M + ROOM_M)


@given(st.floats(0.2, 3.0), angles, angles, st.floats(0.01, 0.3), st.floats(-1.0, 1.0), st.floats(0.05, 60.0))
def test_speed_times_watchdog_stays_below_the_free_way_and_the_path_is_the_same(d_m, beta, alpha, v, omega, watchdog):
    sight = at(d_m, beta, alpha)
    told = leashed(RULES, Wish(v, omega), sight, watchdog)
    assert 0.0 <= told.v_mps <= v
    assert told.v_mps * watchdog <= max(0.0, free_way_m(RULES, sight)) + 1e-9
    assert told.v_mps * omega == pytest.approx(told.omega_radps * v)


def test_at_the_table_a_watchdog_of_2_s_leaves_a_quarter_of_the_speed_and_one_of_400_ms_all_of_it():
    sight = at(0.2867)
    assert leashed(RULES, Wish(0.1), sight, 2.0).v_mps == pytest.approx(0.0255, abs=5e-4)
    assert leashed(RULES, Wish(0.1), sight, 0.4).v_mps == 0.1
    assert leashed(RULES, Wish(0.1), at(1.0), 2.0).v_mps == 0.1


@pytest.mark.parametrize("wish", [Wish(-0.1, 0.2), Wish(0.0, 0.3)])
def test_the_way_back_and_turns_on_the_spot_are_not_slowed(wish):
    assert leashed(RULES, wish, at(0.2), 60.0) == wish


def test_of_a_robot_that_does_not_tell_nothing_is_reckoned():
    assert leashed(RULES, Wish(0.1, 0.1), at(0.2), 0.0) == Wish(0.1, 0.1)
    assert leashed(RULES, Wish(0.1, 0.1), UNSEEN, 2.0) == Wish(0.1, 0.1)


def fastest(watchdog_s):
    """That the pilot says in the middle of a trial, 0.45 m before the object."""
    pilot, told = Pilot(Params(train_s=1e3, controller="lc"), 1), []
    for number in range(1, 9):
        now_ns = number * 125_000_000
        pilot.handle(Event(now_ns, "base", BaseState(watchdog_s=watchdog_s), now_ns))
        percept = Percept(visible=True, slope=0.6, pan_rad=0.5, tilt_rad=math.atan2(HEIGHT_M, 0.45))
        told += [o.message.v_mps for o in pilot.handle(Event(now_ns, "percept", percept, now_ns)) if o.port == "drive"]
    return max(told)


def test_the_pilot_hears_of_the_watchdog_from_base():
    assert fastest(0.0) == pytest.approx(0.1)
    assert 0.0 < fastest(4.0) < 0.06
