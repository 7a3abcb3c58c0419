"""The scoreboard: pilot and truth of one frame together, and nothing else."""

import math

import pytest

from report.frames import Scoreboard
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth

FRAME_NS = 125_000_000


def follow(board: Scoreboard, frames: int, **last) -> object:
    """A trial of so many frames in which the robot is on its way, then one that ends it."""
    ended = None
    for k in range(frames):
        state = {"ended": 1, **last} if k == frames - 1 else {}
        board.take(Trial(mode=Trial.APPROACH, controller="lc", **state), k * FRAME_NS)
        ended = board.take(Truth(x_m=-1.0 + 0.01 * k, d_axle_m=1.0), k * FRAME_NS)
    return ended


def test_a_trial_is_scored_when_both_halves_of_its_last_frame_are_there():
    board = Scoreboard()
    trial = follow(board, 9, outcome=Trial.REACHED, goal_reached=True)
    assert board.scorer.trials == [trial]
    assert (trial.duration_s, trial.controller, trial.reached) == (1.0, "lc", True)
    assert len(trial.path) == 8
    assert board.robot_s == 1.0


@pytest.mark.parametrize(
    "message",
    [
        Trial(phase=7),
        Trial(mode=77),
        Trial(outcome=-1),
        Truth(x_m=math.nan),
        Truth(v_mps=math.inf),
        Truth(object_u_px=-math.inf),
    ],
)
def test_nonsense_changes_nothing(message):
    board = Scoreboard()
    assert board.take(message, 10**18) is None
    assert (board.robot_s, board.trial, board.scorer.trials) == (0.0, None, [])
    assert follow(board, 4) is not None


def test_halves_of_different_frames_are_never_joined():
    board = Scoreboard()
    for k in range(200):
        board.take(Trial(mode=Trial.APPROACH, ended=k), 2 * k * FRAME_NS)
        board.take(Truth(), (2 * k + 1) * FRAME_NS)
    assert board.scorer.trials == []
