"""What became of each trial, judged by ground truth. For evaluation, never for a component."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from docking.angles import DEG, wrap

DOCKED_M = 0.02
DOCKED_RAD = 4.0 * DEG
"""A docking: gripper within 2 cm and 4 deg of its pose, the robot at rest."""
_REST_MPS = 0.005


class Frame(NamedTuple):
    """One frame of a session: what the pilot said it was doing, and the truth."""

    time_s: float
    phase: str
    """TRAIN, EVALUATE or FINISHED."""
    mode: str
    """WAIT, APPROACH, SERVO, GRASP, REVERSE or PLACE."""
    number: int
    ended: int
    outcome: str
    """Of the newest ended trial."""
    goal_reached: bool
    controller: str
    x_m: float
    y_m: float
    heading_rad: float
    v_mps: float
    beta_rad: float
    alpha_rad: float
    d_axle_m: float
    gripper_lateral_m: float
    gripper_longitudinal_m: float
    collided: bool
    holding: bool
    dock_share: float = 0.0
    """Forecast by the policy before the robot moved; 0 = none."""


@dataclass
class Trial:
    """One trial, from its first frame to the frame in which the pilot ended it."""

    phase: str
    number: int
    controller: str
    began_s: float
    start: tuple[float, float, float]
    """(beta_rad, alpha_rad, d_axle_m) where it began."""
    ended_s: float = 0.0
    outcome: str = "NONE"
    """As the pilot saw it."""
    reached: bool = False
    docked: bool = False
    picked: bool = False
    collided: bool = False
    dock_share: float = 0.0
    """Probability of docking that was forecast before the robot moved; 0 = none was."""
    gripper_error_m: float = math.nan
    heading_error_rad: float = math.nan
    path: list[tuple[float, float]] = field(default_factory=list)
    """(x_m, y_m) of the axle, one per frame."""

    @property
    def duration_s(self) -> float:
        """Robot time from start to the end."""
        return self.ended_s - self.began_s


class Scorer:
    """Folds frames into trials."""

    def __init__(self, *, keeps_paths: bool = True) -> None:
        """Nothing was tried.

        Args:
            keeps_paths: of all trials; else of the newest alone, as a session needs that goes on for hours.
        """
        self._keeps_paths = keeps_paths
        self.trials: list[Trial] = []
        self.collisions = 0
        self._open: Trial | None = None
        self._ended: dict[str, int] = {}
        self._in_collision = False

    def frame(self, frame: Frame) -> Trial | None:
        """Take one frame; returns the trial that ended with it, if one did."""
        self._count_collision(frame)
        if frame.phase == "FINISHED":
            return None
        before = self._ended.get(frame.phase, 0)
        self._ended[frame.phase] = frame.ended
        closed = self._close(frame) if frame.ended > before else None
        if closed is not None:
            return closed
        if frame.mode in {"APPROACH", "SERVO", "GRASP"}:
            self._follow(frame)
        elif self._open is not None and frame.mode in {"REVERSE", "PLACE"}:
            self._open = None
        return None

    def _count_collision(self, frame: Frame) -> None:
        self.collisions += frame.collided and not self._in_collision
        self._in_collision = frame.collided

    def _follow(self, frame: Frame) -> None:
        trial = self._open
        if trial is None or (trial.phase, trial.number) != (frame.phase, frame.number):
            start = (frame.beta_rad, frame.alpha_rad, frame.d_axle_m)
            trial = self._open = Trial(frame.phase, frame.number, frame.controller, frame.time_s, start)
        _judge(trial, frame)
        trial.path.append((frame.x_m, frame.y_m))

    def _close(self, frame: Frame) -> Trial | None:
        trial, self._open = self._open, None
        if trial is None:
            return None
        _judge(trial, frame)
        trial.ended_s = frame.time_s
        trial.outcome = frame.outcome
        trial.reached = trial.reached or frame.outcome == "REACHED"
        if self.trials and not self._keeps_paths:
            self.trials[-1].path = []
        self.trials.append(trial)
        return trial

    def last(self, count: int, phase: str) -> list[Trial]:
        """The newest `count` trials of a phase."""
        return [trial for trial in self.trials if trial.phase == phase][-count:]


def _judge(trial: Trial, frame: Frame) -> None:
    trial.reached = trial.reached or frame.goal_reached
    trial.collided = trial.collided or frame.collided
    trial.picked = trial.picked or frame.holding
    trial.dock_share = frame.dock_share or trial.dock_share
    if frame.mode == "GRASP" and abs(frame.v_mps) < _REST_MPS and math.isnan(trial.gripper_error_m):
        trial.gripper_error_m = math.hypot(frame.gripper_lateral_m, frame.gripper_longitudinal_m)
        trial.heading_error_rad = abs(wrap(frame.heading_rad))
        trial.docked = trial.gripper_error_m <= DOCKED_M and trial.heading_error_rad <= DOCKED_RAD


def brier(trials: list[Trial]) -> tuple[float, int]:
    """(mean square error of the forecasts, 0 = always right and certain; number of trials that had one)."""
    told = [trial for trial in trials if trial.dock_share > 0.0]
    return (sum((trial.dock_share - trial.docked) ** 2 for trial in told) / len(told) if told else math.nan), len(told)


def outcomes(trials: list[Trial]) -> Iterator[tuple[str, int]]:
    """How many trials were reached, docked, picked, collided, lost, timed out: counted apart."""
    yield "reached", sum(trial.reached for trial in trials)
    yield "docked", sum(trial.docked for trial in trials)
    yield "picked", sum(trial.picked for trial in trials)
    yield "collided", sum(trial.collided for trial in trials)
    yield "lost", sum(trial.outcome == "LOST" for trial in trials)
    yield "timed out", sum(trial.outcome == "TIMED_OUT" for trial in trials)
