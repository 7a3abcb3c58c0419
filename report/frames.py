"""Joins what the pilot said with the truth, frame by frame, and scores it: live from the bus or from a file."""

from __future__ import annotations

import math
from operator import attrgetter

from docking.score import Frame, Scorer
from docking.score import Trial as ScoredTrial
from report.pairs import Pairs
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth

_reals = attrgetter(*(field.name for field in Truth.DESCRIPTOR.fields if field.type == field.TYPE_DOUBLE))
_PHASES, _MODES, _OUTCOMES = (frozenset(names.values()) for names in (Trial.Phase, Trial.Mode, Trial.Outcome))


def is_sane(message: Trial | Truth) -> bool:
    """Whether a message from the bus or a file can be scored: words that we know, numbers that are finite."""
    if isinstance(message, Trial):
        known = message.phase in _PHASES and message.mode in _MODES and message.outcome in _OUTCOMES
        return known and 0.0 <= message.dock_share <= 1.0  # false for NaN
    return math.isfinite(sum(_reals(message)))  # once a frame: three times as fast as to ask each


class Scoreboard:
    """Pairs `Trial` and `Truth` by capture time and feeds a `Scorer`."""

    def __init__(self, *, keeps_paths: bool = True) -> None:
        """No trial yet; `keeps_paths` as of `Scorer`."""
        self.scorer = Scorer(keeps_paths=keeps_paths)
        self.robot_s = 0.0
        self.trial: Trial | None = None
        """The newest one."""
        self._pairs: Pairs[Trial, Truth] = Pairs()

    def take(self, message: Trial | Truth, capture_ns: int) -> ScoredTrial | None:
        """Take one message; returns the trial that ended with it, if one did. Nonsense changes nothing."""
        if not is_sane(message):
            return None
        self.robot_s = max(self.robot_s, capture_ns * 1e-9)
        if isinstance(message, Trial):
            self.trial = message
            pair = self._pairs.first(capture_ns, message)
        else:
            pair = self._pairs.second(capture_ns, message)
        return self.scorer.frame(joined(*pair, capture_ns)) if pair is not None else None


def joined(trial: Trial, truth: Truth, capture_ns: int) -> Frame:
    """One frame of a session as plain values."""
    return Frame(
        time_s=capture_ns * 1e-9,
        phase=Trial.Phase.Name(trial.phase),
        mode=Trial.Mode.Name(trial.mode),
        number=trial.number,
        ended=trial.ended,
        outcome=Trial.Outcome.Name(trial.outcome),
        goal_reached=trial.goal_reached,
        controller=trial.controller,
        x_m=truth.x_m,
        y_m=truth.y_m,
        heading_rad=truth.heading_rad,
        v_mps=truth.v_mps,
        beta_rad=truth.beta_rad,
        alpha_rad=truth.alpha_rad,
        d_axle_m=truth.d_axle_m,
        gripper_lateral_m=truth.gripper_lateral_m,
        gripper_longitudinal_m=truth.gripper_longitudinal_m,
        collided=truth.collided,
        holding=truth.holding,
        dock_share=trial.dock_share,
    )
