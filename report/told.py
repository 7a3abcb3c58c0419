"""Trials as the robot itself tells of them, where nobody knows the truth: a real robot's session."""

from __future__ import annotations

import math

from components.pilot.sight import sight_of
from docking.score import Frame, Scorer
from docking.score import Trial as ScoredTrial
from docking.task import Task
from report.pairs import Pairs
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial

_DOCKED = frozenset({"ARRIVED", "PICKED"})
_NAN = math.nan


class Told:
    """Pairs `Trial` and `Percept` by capture time. Lengths are in camera heights: the robot knows no metre."""

    def __init__(self, task: Task) -> None:
        """Begin."""
        self._task = task
        self._scorer = Scorer()
        self._pairs: Pairs[Trial, Percept] = Pairs()
        self._place = (_NAN, _NAN, _NAN)
        """beta, alpha, distance where the object was seen last."""

    def take(self, message: Trial | Percept, capture_ns: int) -> None:
        """Take one sane message."""
        halves = self._pairs
        pair = halves.first(capture_ns, message) if isinstance(message, Trial) else halves.second(capture_ns, message)
        if pair is not None:
            self._scorer.frame(self._frame(*pair, capture_ns))

    def trials(self) -> list[ScoredTrial]:
        """Those that have ended: docked means that the robot says it stands at the pick-up."""
        for trial in self._scorer.trials:
            trial.docked, trial.picked = trial.outcome in _DOCKED, trial.outcome == "PICKED"
            trial.collided = trial.outcome == "COLLIDED"
            trial.path = [(x, y) for x, y in trial.path if math.isfinite(x) and math.isfinite(y)]
        return self._scorer.trials

    def _frame(self, trial: Trial, percept: Percept, capture_ns: int) -> Frame:
        sight = sight_of(self._task, percept.visible, percept.slope, percept.pan_rad, percept.tilt_rad)
        if sight.visible:
            self._place = (sight.beta_rad, sight.alpha_rad, 1.0 / math.tan(sight.tilt_rad))
        beta_rad, alpha_rad, d = self._place
        return Frame(
            capture_ns * 1e-9,
            Trial.Phase.Name(trial.phase),
            Trial.Mode.Name(trial.mode),
            trial.number,
            trial.ended,
            Trial.Outcome.Name(trial.outcome),
            trial.goal_reached,
            trial.controller,
            x_m=-d * math.cos(beta_rad),
            y_m=-d * math.sin(beta_rad),
            heading_rad=beta_rad - alpha_rad,
            v_mps=_NAN,
            beta_rad=beta_rad,
            alpha_rad=alpha_rad,
            d_axle_m=d,
            gripper_lateral_m=_NAN,
            gripper_longitudinal_m=_NAN,
            collided=False,
            holding=False,
            dock_share=trial.dock_share,
        )
