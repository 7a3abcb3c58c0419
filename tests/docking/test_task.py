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
    assert task.state(0.1, 0.05, task.goal_tilt_rad) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_mirroring_swaps_the_actions():
    (v, left), (w, right) = Task().actions
    assert (v, left) == (w, -right)
    assert left > 0
