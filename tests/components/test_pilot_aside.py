"""A pilot whose camera is beside the axis and yawed docks like one whose camera is not."""

from dataclasses import asdict

import pytest

from benchmarks.aside import Subtracted, docks, taught
from benchmarks.goal import TUNED
from docking.angles import DEG
from docking.pinhole import Mount

STARTS = range(6)
AXIS = Mount(up_m=0.45)


@pytest.mark.parametrize("aside", [Mount(0.0, 0.05, 0.45, 3 * DEG), Mount(0.0, -0.1, 0.6, -6 * DEG)])
def test_from_the_same_starts_the_linear_law_docks_as_with_a_camera_on_the_axis(aside):
    on_axis = [docks(AXIS, taught(AXIS), TUNED, number) for number in STARTS]
    assert [docks(aside, taught(aside), TUNED, number) for number in STARTS] == on_axis
    assert sum(on_axis) >= 5


def test_with_the_goal_merely_subtracted_none_docks():
    """Why the taught goal must tell where the camera is."""
    aside = Mount(0.0, 0.05, 0.45, 3 * DEG)
    task = Subtracted(**asdict(taught(aside)))
    assert not any(docks(aside, task, TUNED, number) for number in STARTS)
