"""The ceiling, against closed forms, a slow twin, and what must hold whatever the numbers."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from docking import plant
from docking.angles import DEG
from docking.cells import Grid
from docking.levels import FAR, goal_level, judge, sink_level
from docking.task import Task
from docking.value_iteration import LATE_S, interpolated
from experiments.controller import docking_times, points_of, trace
from experiments.problem import Problem, action_set
from experiments.reach_avoid import Ceiling, solve
from experiments.rollout import step
from experiments.starts import Starts, demo_starts, protocol_starts
from runtime.params import ConfigurationError

COARSE = {"angle_step_rad": 1.0 * DEG, "distance_step_m": 0.0125}
ROUGH = {"angle_step_rad": 2.0 * DEG, "distance_step_m": 0.025, "backup_samples": 2}
TINY = {"angle_step_rad": 20.0 * DEG, "distance_step_m": 0.3, "backup_samples": 8}

angles = st.floats(-1.5, 1.5)


@pytest.fixture(scope="module")
def paper() -> Ceiling:
    return solve(Problem(**COARSE), levels=True)


@pytest.fixture(scope="module")
def rough() -> Ceiling:
    return solve(Problem(**ROUGH), levels=True)


@settings(deadline=None)  # the first call compiles
@given(angles, angles, st.floats(0.2, 2.0))
def test_the_goal_s_level_is_at_most_0_in_the_goal_cell_and_nowhere_else(b: float, a: float, d: float) -> None:
    grid = Grid.of(Task())
    edge = min(abs(abs(b) - 65 * DEG), abs(abs(a) - 80 * DEG), abs(abs(b) - 65 * DEG / 31), abs(abs(a) - 80 * DEG / 31))
    if edge > 1e-9:
        assert (goal_level(Problem().limits, b, a, d) <= 0) == (grid.cell(b, a) == grid.goal)


@settings(deadline=None)  # the first call compiles
@given(st.floats(-0.15, 0.15), st.floats(-0.15, 0.15), st.floats(0.2, 0.5), st.sampled_from([0.28, 0.4]))
def test_a_docking_is_the_gripper_within_2_cm_and_4_deg_of_its_pose(b: float, a: float, d: float, g: float) -> None:
    x, y, heading = plant.pose(b, a, d)
    miss = math.hypot(x + g * math.cos(heading), y + g * math.sin(heading))
    docked = miss <= 0.02 and abs(heading) <= 4 * DEG
    if abs(miss - 0.02) > 1e-9 and abs(abs(heading) - 4 * DEG) > 1e-9:
        assert (goal_level(Problem(goal="dock", gripper_m=g).limits, b, a, d) <= 0) == docked


@settings(deadline=None)  # the first call compiles
@given(angles, angles, st.floats(0.01, 3.0))
def test_the_sink_is_outside_the_ranges_or_too_close_or_too_far(b: float, a: float, d: float) -> None:
    outside = abs(b) > 65 * DEG or abs(a) > 80 * DEG or d < 0.2 or d > 2.0
    assert (sink_level(Problem().limits, b, a, d) > 0) == outside


def test_the_goal_cell_nearer_than_the_sink_is_the_sink() -> None:
    assert judge(Problem().limits, np.array([[0.0, 0.0, 0.2], [0.0, 0.0, 0.1999]])).tolist() == [1, -1]


def test_nan_is_the_sink() -> None:
    assert judge(Problem().limits, np.array([[math.nan, 0.5, 1.0], [0.5, 0.5, math.nan]])).tolist() == [-1, -1]


def test_interpolation_is_exact_on_functions_that_are_linear_along_each_axis() -> None:
    beta, alpha, d = np.linspace(-1, 1, 5), np.linspace(-2, 2, 9), np.linspace(0.2, 2.0, 4)

    def trilinear(d_m: float, a: float, b: float) -> float:
        return 1 + 2 * b - a + 3 * d_m + b * a - 2 * a * d_m + b * a * d_m

    value = np.array([[[trilinear(x, y, z) for z in beta] for y in alpha] for x in d])
    for b, a, far in np.random.default_rng(3).uniform((-1, -2, 0.2), (1, 2, 2.0), (50, 3)):
        assert interpolated(value, (beta, alpha, d), b, a, far) == pytest.approx(trilinear(far, a, b))


@pytest.mark.parametrize("actions", ["one-speed", "reverse"])
@pytest.mark.parametrize("timed", [True, False])
def test_values_are_the_fixed_point_that_a_textbook_loop_finds(actions: str, timed: bool) -> None:
    problem = Problem(actions=action_set(actions, 0.1, 10 * DEG), **TINY)
    ceiling = solve(problem, levels=True)
    ours = ceiling.times_s if timed else ceiling.levels
    nodes, limits, dt = problem.nodes, problem.limits, 1.0
    slow = np.full([len(axis) for axis in reversed(nodes)], LATE_S if timed else FAR)
    points = [(i, *p) for i, p in zip(np.ndindex(slow.shape), itertools.product(*reversed(nodes)), strict=True)]

    def promise(b: float, a: float, d: float, v: float, omega: float) -> float:
        b, a, d = step(False, b, a, d, v, omega, dt)
        goal, sink = goal_level(limits, b, a, d), sink_level(limits, b, a, d)
        onward = interpolated(slow, nodes, b, a, d)
        if not timed:
            return min(goal, max(sink, onward))
        return dt if goal <= 0 else LATE_S if sink > 0 else dt + onward

    for _ in range(300):
        before, after = slow.copy(), slow.copy()
        for place, d, a, b in points:
            here = goal_level(limits, b, a, d)
            best = min(promise(b, a, d, *action) for action in problem.actions)
            after[place] = (0.0 if here <= 0 else min(best, LATE_S)) if timed else min(here, best, FAR)
        slow = after
        if np.abs(after - before).max() < 1e-4:
            break
    assert ours == pytest.approx(slow, abs=0.05)


def test_turning_on_the_spot_takes_the_angle_to_the_goal_cell_over_the_turn_rate() -> None:
    problem = Problem(actions=((0.0, 10 * DEG), (0.0, -10 * DEG)), **COARSE)
    ceiling = solve(problem)
    alpha = np.array([-70.0, -31.0, 0.0, 12.0, 55.0]) * DEG
    expected = np.ceil(np.maximum(np.abs(alpha) - 80 * DEG / 31, 0) / (10 * DEG) / 0.125) * 0.125
    assert ceiling.time_s(1 * DEG, alpha, 1.0) == pytest.approx(expected)
    assert not ceiling.reachable(3 * DEG, alpha, 1.0).any()


def test_half_the_speed_and_turn_rate_at_half_the_sampling_rate_reach_the_same_states(rough: Ceiling) -> None:
    slow = solve(Problem(actions=action_set("one-speed", 0.05, 5 * DEG), sampling_s=0.25, **ROUGH), levels=True)
    assert slow.levels is not None
    assert rough.levels is not None
    assert np.abs(slow.levels - rough.levels).max() < 0.01


def test_the_mirrored_start_takes_as_long(paper: Ceiling) -> None:
    assert np.abs(paper.times_s[:, ::-1, ::-1] - paper.times_s).max() < 0.05


def test_the_paper_s_actions_reach_what_the_protocol_says(paper: Ceiling) -> None:
    """Prototypes drove 61.8 % of the starts to the goal in 12.1 s; fine nodes do 63.6 %, coarse ones a little less."""
    starts = protocol_starts()
    times = paper.time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)
    per_distance = 100 * np.isfinite(times).reshape(5, -1).mean(axis=1)
    assert per_distance == pytest.approx([22.6, 48.8, 66.9, 80.2, 90.6], abs=1.5)
    assert times[np.isfinite(times)].mean() == pytest.approx(12.1, abs=0.7)


def test_level_set_and_driven_policy_agree_but_at_the_edge(paper: Ceiling) -> None:
    starts = protocol_starts()
    driven = paper.reachable(starts.beta_rad, starts.alpha_rad, starts.d_m)
    level = paper.level(starts.beta_rad, starts.alpha_rad, starts.d_m)
    wrong = driven != (level <= 0)
    assert wrong.mean() < 0.025
    assert np.abs(level[wrong]).max() < 0.5  # half a goal cell


def test_nearly_every_demo_start_can_be_docked_from(paper: Ceiling) -> None:
    starts = demo_starts(500)
    assert paper.reachable(starts.beta_rad, starts.alpha_rad, starts.d_m).mean() >= 0.97


def test_a_second_speed_reaches_a_superset_and_is_never_slower(rough: Ceiling) -> None:
    two = solve(Problem(actions=action_set("two-speeds", 0.1, 10 * DEG), **ROUGH), levels=True)
    assert two.levels is not None
    assert rough.levels is not None
    assert (two.levels <= rough.levels + 0.01).all()
    assert (two.times_s <= rough.times_s + 0.02).all()
    assert (two.levels <= 0).mean() > (rough.levels <= 0).mean() + 0.1


def test_a_controller_that_predicts_loses_only_the_delay(paper: Ceiling) -> None:
    starts = demo_starts(50)
    late = Problem(delay_samples=2, **COARSE)
    on_time = docking_times(paper.act, starts, paper.problem)
    assert docking_times(paper.act, starts, late) == pytest.approx(on_time + 0.25)
    blind = docking_times(paper.act, starts, late, predicts=False)
    assert not np.allclose(blind, on_time + 0.25)


def test_a_trace_ends_where_its_docking_time_says(paper: Ceiling) -> None:
    starts = Starts(np.array([0.5, 0.0, 1.1]), np.array([0.2, 0.0, -1.3]), np.array([1.6, 1.0, 0.5]))
    times = paper.time_s(starts.beta_rad, starts.alpha_rad, starts.d_m)
    paths = trace(paper.act, starts, paper.problem)
    reached = [judge(paper.problem.limits, path[-1:])[0] == 1 for path in paths]
    assert reached == np.isfinite(times).tolist()
    assert [0.125 * (len(path) - 1) for path in paths[:2]] == pytest.approx(times[:2].tolist())


def test_points_repeat_single_numbers() -> None:
    assert points_of(0.1, [0.2, 0.3], 1.0).tolist() == [[0.1, 0.2, 1.0], [0.1, 0.3, 1.0]]


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"plant": "flat"}, "problem.plant must be one of geometric, printed"),
        ({"goal": "pole"}, "problem.goal must be one of cell, dock"),
        ({"angle_step_rad": 0.0}, "must be > 0"),
        ({"actions": ((math.nan, 1.0),)}, "problem.actions must be finite"),
    ],
)
def test_a_wrong_problem_is_refused_by_name(values: dict[str, object], words: str) -> None:
    with pytest.raises(ConfigurationError, match=words):
        Problem(**values)
