"""Trials of a robot that nobody watches: what it says itself, and where it believed to be."""

import math

import pytest

from docking.plant import observe
from docking.task import Task
from report.told import Told
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial

FRAME_NS = 125_000_000
TASK = Task()


def percept(x, y, heading):
    """What a perfect robot sees of the object; lengths in camera heights."""
    beta, alpha, d = observe(x, y, heading)
    tilt = math.atan(1 / d)
    return Percept(visible=True, slope=math.tan(beta) * math.sin(tilt), pan_rad=alpha, tilt_rad=tilt)


def told(outcome, *, goal_reached=True):
    teller = Told(TASK)
    for k in range(9):
        at_end = {"ended": 1, "outcome": outcome, "goal_reached": goal_reached} if k == 8 else {}
        teller.take(Trial(phase=Trial.EVALUATE, mode=Trial.APPROACH, controller="greedy", **at_end), k * FRAME_NS)
        teller.take(percept(-3 + 0.1 * k, 0.4, -0.1), k * FRAME_NS)
    return teller.trials()


@pytest.mark.parametrize(
    ("outcome", "docked", "picked", "collided"),
    [
        (Trial.ARRIVED, True, False, False),
        (Trial.PICKED, True, True, False),
        (Trial.MISSED, False, False, False),
        (Trial.COLLIDED, False, False, True),
    ],
)
def test_success_is_what_the_robot_says(outcome, docked, picked, collided):
    (trial,) = told(outcome)
    assert (trial.docked, trial.picked, trial.collided) == (docked, picked, collided)
    assert (trial.reached, trial.duration_s, trial.controller) == (True, 1.0, "greedy")


def test_the_path_is_where_the_percepts_say_in_camera_heights():
    (trial,) = told(Trial.PICKED)
    assert len(trial.path) == 8
    for k, (x, y) in enumerate(trial.path):
        assert (x, y) == pytest.approx((-3 + 0.1 * k, 0.4), abs=0.02)


def test_before_the_object_was_seen_the_robot_is_nowhere():
    teller = Told(TASK)
    for k in range(4):
        teller.take(Trial(mode=Trial.APPROACH, ended=int(k == 3), outcome=Trial.LOST), k * FRAME_NS)
        teller.take(Percept(), k * FRAME_NS)
    (trial,) = teller.trials()
    assert trial.path == []
