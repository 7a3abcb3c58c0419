"""The task in perceptual space."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from docking.angles import DEG
from docking.task import Task

angles = st.floats(-1.1, 1.1)
tilts = st.floats(0.2, 1.1)


@given(angles, tilts)
def test_beta_read_through_the_tilt_is_exact_at_the_image_centre(beta, tilt):
    slope = math.tan(beta) * math.sin(tilt)
    assert Task().beta(slope, tilt) == pytest.approx(beta, abs=1e-9)


def test_the_papers_arctan_reads_30_degrees_as_11_at_tilt_20_and_as_21_at_43():
    task = Task(beta_reading="arctan")
    read = [task.beta(math.tan(30 * DEG) * math.sin(tilt * DEG), tilt * DEG) / DEG for tilt in (20, 43)]
    assert read == pytest.approx([11.2, 21.5], abs=0.1)


def test_the_goal_is_the_origin_wherever_it_was_taught():
    task = Task(goal_slope=0.1, goal_pan_rad=0.05)
    assert task.seen(0.1, 0.05, task.goal_tilt_rad)[:3] == pytest.approx((0.0, 0.0, task.arrival_tilt_rad), abs=1e-12)


def test_mirroring_swaps_the_actions():
    (v, left), (w, right) = Task().actions
    assert (v, left) == (w, -right)
    assert left > 0


@given(st.floats(-1.2, 1.2), st.floats(0.2, 2.0))
def test_too_close_is_a_distance_to_the_tables_edge_not_to_the_object(beta, d):
    """A camera h above an object at distance d, seen at beta, is d cos(beta) from the line along the edge."""
    task, height_m = Task(), 0.45
    nearest_m = height_m / math.tan(task.tilt_limit_rad)
    if abs(d * math.cos(beta) - nearest_m) < 1e-6:
        return
    tilt = math.atan2(height_m, d)
    assert task.seen(math.tan(beta) * math.sin(tilt), 0.0, tilt).too_close == (d * math.cos(beta) < nearest_m)
