"""The simulated base moves only as commanded, and as a body can."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from components.simulator.base import Base, Pose, Twist
from components.simulator.params import Params
from docking.angles import DEG

STEP_NS, STEP_S = 15_625_000, 1 / 64


def run(base, seconds, command=None, begin_ns=0, every=8):
    """Step the base; give the command every 0.125 s. Returns (time_s, v, omega, pose) per step."""
    trace = []
    for step in range(round(seconds * 64)):
        now_ns = begin_ns + step * STEP_NS
        if command is not None and step % every == 0:
            base.command(command, now_ns)
        base.step(now_ns, STEP_S)
        trace.append(((now_ns + STEP_NS) * 1e-9, base.v_mps, base.omega_radps, base.pose.triple))
    return trace


def free(**changes):
    return Base(Params(**changes), Pose(-3.0, 0.0, 0.0))


def test_without_a_command_it_never_moves():
    trace = run(free(), 2.0)
    assert {state[3] for state in trace} == {(-3.0, 0.0, 0.0)}


def test_it_accelerates_no_faster_than_its_limits():
    trace = run(free(), 2.0, Twist(0.5, 140 * DEG))
    steps = list(itertools.pairwise(trace))
    assert max(after[1] - before[1] for before, after in steps) <= 0.3 * STEP_S + 1e-12
    assert max(after[2] - before[2] for before, after in steps) <= 100 * DEG * STEP_S + 1e-12
    assert trace[-1][1:3] == pytest.approx((0.5, 140 * DEG))


def test_a_command_acts_after_its_latency():
    trace = run(free(command_latency_s=0.1), 0.5, Twist(0.1, 0.0))
    first = next(time_s for time_s, v, *_ in trace if v > 0)
    assert 0.1 < first <= 0.1 + 2 * STEP_S


def test_a_world_that_stood_still_brakes_while_it_catches_up_with_the_commands_that_came_meanwhile():
    base = free()
    run(base, 1.0, Twist(0.1, 0.0))
    base.command(Twist(0.0, 0.0), round(2e9))
    trace = run(base, 1.0, begin_ns=64 * STEP_NS)
    assert max(time_s for time_s, v, *_ in trace if v > 0.0) < 56 / 64 + 0.3 + 0.1 / 0.3 + 2 * STEP_S


def test_a_late_stop_does_not_bring_back_what_was_wished_before_it():
    base = free()
    run(base, 1.0, Twist(0.1, 0.2))
    run(base, 1.0, begin_ns=64 * STEP_NS)
    trace = run(base, 0.5, Twist(0.0, 0.0), begin_ns=128 * STEP_NS)
    assert {(v, omega) for _, v, omega, _ in trace} == {(0.0, 0.0)}


def test_it_brakes_by_itself_when_no_command_comes():
    base = free()
    run(base, 1.0, Twist(0.3, 0.5))
    trace = run(base, 2.0, begin_ns=64 * STEP_NS)
    stopped = next(time_s for time_s, v, omega, _ in trace if v == 0 and omega == 0)
    last_command_s = 56 * STEP_NS * 1e-9
    assert last_command_s + 0.3 < stopped <= last_command_s + 0.3 + 0.3 / 0.3 + 2 * STEP_S


@pytest.mark.parametrize("twist", [(math.nan, 0), (0, math.nan), (math.inf, 0), (0, -math.inf), (1e9, 0), (0, 1e300)])
def test_nonsense_brakes(twist):
    base = free()
    run(base, 1.0, Twist(0.2, 0.1))
    run(base, 1.5, Twist(*twist), begin_ns=64 * STEP_NS)
    assert (base.v_mps, base.omega_radps) == (0.0, 0.0)


def test_a_full_circle_ends_where_it_began():
    base = free(angular_acceleration_radps2=1e6, acceleration_mps2=1e6, command_latency_s=0.0)
    run(base, 8.0, Twist(0.1, 2 * math.pi / 8.0))
    assert base.pose.triple == pytest.approx((-3.0, 0.0, 2 * math.pi), abs=1e-9)


def test_the_table_stops_it_and_the_bumper_tells_until_it_backs_off():
    base = Base(Params(), Pose(-0.5, 0.1, 0.0))
    run(base, 5.0, Twist(0.1, 0.0))
    assert base.pose.x_m == pytest.approx(-0.05 - 0.18, abs=0.1 * STEP_S)
    assert base.pose.x_m <= -0.05 - 0.18
    assert base.bumper
    assert base.v_mps == 0.0
    run(base, 1.0, Twist(-0.1, 0.0), begin_ns=5_000_000_000)
    assert not base.bumper
    assert base.pose.x_m < -0.25


def test_it_may_back_out_of_the_table():
    base = Base(Params(), Pose(-0.15, 0.0, 0.0))
    run(base, 3.0, Twist(-0.1, 0.0))
    assert base.pose.x_m < -0.3
    assert not base.bumper


def test_it_may_turn_at_the_table():
    base = Base(Params(), Pose(-0.24, 0.0, 0.0))
    run(base, 3.0, Twist(0.1, 0.3))
    assert base.bumper
    assert base.pose.heading_rad > 0.7


@given(st.floats(-1.5, 1.5), st.floats(-2.0, 2.0), st.floats(-3.2, 3.2), st.floats(-0.5, 0.5), st.floats(-2.0, 2.0))
def test_no_drive_takes_it_into_the_table(x, y, heading, v, omega):
    base = Base(Params(), Pose(x, y, heading))
    before_m = base.clearance_m(base.pose)
    run(base, 1.0, Twist(v, omega))
    assert base.clearance_m(base.pose) >= min(before_m, 0.0) - 1e-9


def test_clearance_is_the_distance_to_the_tables_rectangle():
    base = free()
    for x_m, y_m, gap_m in (
        (-0.5, 0.0, 0.45),
        (0.3, 1.6, 0.4),
        (-0.35, 1.6, 0.5),
        (1.05, -1.6, 0.5),
        (0.0, 0.0, -0.05),
    ):
        assert base.clearance_m(Pose(x_m, y_m, 0.0)) == pytest.approx(gap_m - 0.18), (x_m, y_m)
