"""Start poses: seeded, uniform, inside their ranges."""

import numpy as np
import pytest

from docking.angles import DEG
from docking.starts import KINDS, span, start
from docking.task import Task

TASK = Task()


def many(kind, seed=3, count=2000):
    return np.array([start(kind, seed, number, TASK) for number in range(count)])


@pytest.mark.parametrize("kind", KINDS)
def test_starts_fill_their_ranges_evenly(kind):
    ranges = span(kind, TASK)
    low = np.array((-ranges.beta_rad, -ranges.alpha_rad, ranges.nearest_m))
    high = np.array((ranges.beta_rad, ranges.alpha_rad, ranges.farthest_m))
    share = (many(kind) - low) / (high - low)
    assert share.min() >= 0
    assert share.max() <= 1
    quarters = np.apply_along_axis(lambda column: np.histogram(column, 4, (0, 1))[0], 0, share)
    assert np.abs(quarters - 500).max() < 80  # 4 standard deviations
    assert np.abs(np.corrcoef(share.T) - np.eye(3)).max() < 0.1


def test_demo_starts_are_those_of_the_demo():
    assert span("demo", TASK) == (45 * DEG, 30 * DEG, 1.5, 2.0)


def test_full_starts_cover_the_task():
    assert span("full", TASK) == (TASK.beta_range_rad, TASK.alpha_range_rad, 1.0, 2.0)


def test_same_number_gives_the_same_start_and_another_number_another():
    assert start("demo", 7, 12, TASK) == start("demo", 7, 12, TASK)
    assert len(set(map(tuple, many("demo", count=500)))) == 500
    assert start("demo", 8, 12, TASK) != start("demo", 7, 12, TASK)


def test_unknown_kind_is_named():
    with pytest.raises(ValueError, match="demo, full; got 'easy'"):
        start("easy", 0, 0, TASK)
