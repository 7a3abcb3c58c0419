import math

import pytest

from components.tracker.height import at_share
from docking.task import Task


@pytest.mark.parametrize("share", [0.8, 0.9, 1.0, 1.1, 1.25])
@pytest.mark.parametrize("beta_rad", [-0.9, 0.0, 0.4])
@pytest.mark.parametrize("distance_m", [0.3, 1.0, 2.0])
def test_a_higher_camera_at_the_same_place_gives_the_same_percept(share, beta_rad, distance_m):
    reads = [math.atan2(height_m, distance_m) for height_m in (0.45 * share, 0.45)]
    slopes = [math.tan(beta_rad) * math.sin(tilt_rad) for tilt_rad in reads]
    assert at_share(slopes[0], reads[0], share) == pytest.approx((slopes[1], reads[1]), abs=1e-12)


def test_the_share_is_found_at_the_pick_up():
    task = Task()
    shown_rad = math.atan(1.07 * math.tan(task.goal_tilt_rad))
    share = math.tan(shown_rad) / math.tan(task.goal_tilt_rad)
    assert at_share(0.0, shown_rad, share)[1] == pytest.approx(task.goal_tilt_rad)


def test_a_camera_that_is_as_high_is_believed_to_the_last_bit():
    assert at_share(0.123, 0.456, 1.0) == (0.123, 0.456)
