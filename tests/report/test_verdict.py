"""The four answers at the top of a page: right in the plain cases, careful in the others."""

from pathlib import Path

import pytest

from docking.score import Trial
from report.comparison import Comparison
from report.failures import Failed
from report.incidents import Incident
from report.session import Session
from report.verdict import tiles


def session(docked, trials, phase="EVALUATE", **more):
    rows = [
        Trial(phase, k, "greedy", 0.0, (0.0, 0.0, 1.0), ended_s=20.0, docked=k < docked, gripper_error_m=0.004)
        for k in range(trials)
    ]
    return Session(Path("x.mcap"), {}, {}, whole=True, trials=rows, **more)


def learned(*percents, best=100.0):
    curve = [(float(k), float(percent)) for k, percent in enumerate(percents)]
    return Comparison(500, [(0.0, 99.0)], curve, [], best)


def marks(*arguments):
    return [tile.mark for tile in tiles(*arguments)]


@pytest.mark.parametrize(
    ("last", "best", "mark"), [(90, 100, "good"), (60, 100, "fair"), (20, 100, "bad"), (42, 50, "good"), (0, 0, "bad")]
)
def test_it_has_learned_what_the_policy_alone_can_of_what_is_possible(last, best, mark):
    tile = tiles(session(0, 0), learned(5, last, best=best))[0]
    assert tile.mark == mark
    assert tile.answer.endswith(f"{last} %")
    assert "it was 5 %" in tile.words


@pytest.mark.parametrize(
    ("docked", "trials", "mark"), [(29, 30, "good"), (20, 30, "fair"), (3, 30, "bad"), (2, 2, "fair"), (0, 0, "none")]
)
def test_it_docks_well_only_if_enough_trials_show_it(docked, trials, mark):
    assert marks(session(docked, trials), None)[1] == mark


def test_training_is_not_judged_as_docking():
    tile = tiles(session(0, 30, "TRAIN"), None)[1]
    assert tile.mark == "none"
    assert "not meant to dock" in tile.words


def test_a_robot_that_nobody_watches_is_not_called_measured():
    tile = tiles(session(12, 12, knows_truth=False), None)[1]
    assert "as the robot itself tells" in tile.words
    assert "ground truth" not in tile.words


def test_nothing_went_wrong_is_said_only_if_nothing_did():
    assert marks(session(12, 12), None)[3] == "good"
    failed = [Failed("EVALUATE", 0, "slip", 1.0, 2.0, "SINK", "")]
    assert tiles(session(11, 12, failed=failed), None)[3].answer == "1 failed trial"
    died = [Incident("died", "learner", "died", 1.0, 2.0)]
    tile = tiles(session(12, 12, incidents=died), None)[3]
    assert (tile.mark, tile.answer) == ("bad", "1 fault")
    assert "learner" in tile.words
    torn = session(12, 12)
    torn.whole = False
    assert marks(torn, None)[3] == "bad"


def test_failures_in_training_are_how_it_learns():
    failed = [Failed("TRAIN", 0, "off course", 1.0, 2.0, "SINK", "")]
    assert marks(session(12, 12, failed=failed), None)[3] == "good"
