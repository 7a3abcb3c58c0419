"""How well what was learned predicts what happens: the time that a policy's value promises, and motion a second ahead.

The promise is what the pilot forecasts of a trial, or, where it makes no forecast, the value of the cell in which the
policy began to drive: the goal's reward less one for each sampling period to go, less what the risk of failing costs.
The motion is that of a policy that knows how percepts move: from each percept the commands that were executed are
followed for a second.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.learner.normal_equations import in_force
from components.pilot.messages import table_of
from components.pilot.sight import sight_of
from docking.cells import SINK
from docking.policy import PolicyTable
from docking.rates import RateModel
from docking.task import Task
from report.pairs import Pairs
from runtime.recorded_launch import number_of
from runtime.recording import Logged
from schemas.drive_pb2 import Applied
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial

_LIKELY = 0.5
"""Share from which on a forecast promises the pick-up; as in `report.forecast`."""
_RECENT = 8
"""Policies kept: the pilot acts on one of the newest."""
_AHEAD = 8
"""Samples: a second at 8 Hz."""
_DRIVING = frozenset({Trial.APPROACH, Trial.SERVO})
Floats = NDArray[np.float64]


@dataclass
class Promise:
    """One trial that a policy drove."""

    promised_s: float
    """Time to the goal by its value; NaN where it promised no goal."""
    began_s: float
    phase: str
    is_forecast: bool = False
    """It is about the pick-up pose; else about the goal cell."""
    ended_s: float = math.nan
    """When the robot was there; NaN if it never was."""

    def note(self, trial: Trial, at_s: float) -> None:
        """Another frame of its trial."""
        is_there = trial.mode == Trial.GRASP if self.is_forecast else trial.goal_reached
        if is_there and math.isnan(self.ended_s):
            self.ended_s = at_s

    @property
    def took_s(self) -> float:
        """What it took."""
        return self.ended_s - self.began_s


class Motion(NamedTuple):
    """Errors of the motion predicted a second ahead, `[N]` each, and how much moved."""

    beta_rad: Floats
    alpha_rad: Floats
    distance_share: Floats
    moved: tuple[float, float, float]
    """Median change of beta, alpha (rad) and of ln d within the second."""


@dataclass
class Fit:
    """Of one session."""

    promises: list[Promise] = field(default_factory=list)
    motion: Motion | None = None

    @property
    def kept(self) -> list[Promise]:
        """Promises of the goal that were kept."""
        return [p for p in self.promises if math.isfinite(p.promised_s) and math.isfinite(p.ended_s)]


class FitReader:
    """Folds policies, percepts, trials and executed commands into a fit."""

    def __init__(self, launch: Mapping[str, Any], task: Task) -> None:
        """Begin."""
        self._task = task
        self._goal_reward, self._period_s = number_of(launch, "goal_reward", 300.0), 0.125
        self._newest: deque[Logged] = deque(maxlen=_RECENT)
        self._tables: dict[int, PolicyTable | None] = {}
        self._pairs: Pairs[Trial, Percept] = Pairs()
        self._promises: list[Promise] = []
        self._open: tuple[int, Promise] | None = None
        """When the trial began, and its promise."""
        self._knows_motion = False
        self._states: dict[int, tuple[float, float, float]] = {}
        """By capture time: beta, alpha, ln d, while somebody drove towards the goal."""
        self._commands: dict[int, tuple[float, float]] = {}

    def take_policy(self, logged: Logged) -> None:
        """Take a policy; it is decoded only where one begins to drive by it."""
        if not self._newest:
            table = _table(logged)
            self._knows_motion = table is not None and table.fine is not None
        self._newest.append(logged)

    def take_applied(self, applied: Applied, capture_ns: int) -> None:
        """Take what was executed."""
        if self._knows_motion and math.isfinite(applied.v_mps) and math.isfinite(applied.omega_radps):
            self._commands[capture_ns] = (applied.v_mps, applied.omega_radps)

    def take(self, message: Trial | Percept, capture_ns: int) -> None:
        """Take one sane message."""
        halves = self._pairs
        pair = halves.first(capture_ns, message) if isinstance(message, Trial) else halves.second(capture_ns, message)
        if pair is not None:
            self._frame(*pair, capture_ns)

    def fit(self) -> Fit:
        """What came of it."""
        model = self._last_model()
        return Fit(self._promises, _motion(model, self._states, self._commands) if model is not None else None)

    def _frame(self, trial: Trial, percept: Percept, capture_ns: int) -> None:
        at_s = capture_ns * 1e-9
        is_new = self._open is None or trial.began_ns != self._open[0]
        if self._open is not None and not is_new:
            self._open[1].note(trial, at_s)
        forecasts = trial.dock_share > 0.0 and trial.phase == Trial.EVALUATE  # training ends in the goal cell
        if is_new and forecasts and trial.mode in _DRIVING:
            promised_s = trial.dock_s if trial.dock_share >= _LIKELY else math.nan
            self._promise(trial, Promise(promised_s, at_s, Trial.Phase.Name(trial.phase), is_forecast=True))
            is_new = False
        begins = is_new and trial.controller == "greedy" and trial.mode == Trial.APPROACH
        if not (begins or (self._knows_motion and trial.mode in _DRIVING)):
            return
        sight = sight_of(self._task, percept.visible, percept.slope, percept.pan_rad, percept.tilt_rad)
        if sight.visible and self._knows_motion:
            self._states[capture_ns] = (sight.beta_rad, sight.alpha_rad, -math.log(math.tan(sight.tilt_rad)))
        if sight.visible and begins:
            self._begin(trial, sight.beta_rad, sight.alpha_rad, at_s)

    def _begin(self, trial: Trial, beta_rad: float, alpha_rad: float, at_s: float) -> None:
        table = self._table_of(trial.policy_version)
        cell = SINK if table is None else table.grid.cell(beta_rad, alpha_rad)
        if table is None or table.fine is not None or cell == SINK or table.action[cell] < 0:
            return  # where the distance is known, the cells' values are a picture at one distance
        value = float(table.value[cell])
        promised_s = (self._goal_reward - value) * self._period_s if value > 0.0 else math.nan
        self._promise(trial, Promise(promised_s, at_s, Trial.Phase.Name(trial.phase)))

    def _promise(self, trial: Trial, promise: Promise) -> None:
        self._open = trial.began_ns, promise
        self._promises.append(promise)

    def _table_of(self, version: int) -> PolicyTable | None:
        if version not in self._tables:
            found = None
            for logged in reversed(self._newest):
                table = _table(logged)
                if table is not None and table.version == version:
                    found = table
                    break
            self._tables[version] = found
        return self._tables[version]

    def _last_model(self) -> RateModel | None:
        table = _table(self._newest[-1]) if self._knows_motion else None
        return None if table is None or table.fine is None else table.fine.model


def _table(logged: Logged) -> PolicyTable | None:
    try:
        message = logged.decoded()
        return None if message is None else table_of(message)
    except ValueError:
        return None


def _motion(
    model: RateModel, states: Mapping[int, tuple[float, float, float]], commands: Mapping[int, tuple[float, float]]
) -> Motion | None:
    times = np.array(sorted(states.keys() & commands.keys()), dtype=np.int64)
    lag = int(model.delay_samples) + 1
    if len(times) <= _AHEAD + lag:
        return None
    period_ns = float(np.median(np.diff(times)))
    seen = np.array([states[time] for time in times.tolist()])
    driven = in_force(np.array([commands[time] for time in times.tolist()]), model.delay_samples)
    first = np.arange(lag, len(times) - _AHEAD)
    first = first[times[first + _AHEAD] - times[first - lag] < (_AHEAD + lag + 0.5) * period_ns]  # no frame is missing
    state = seen[first]
    for step in range(_AHEAD):
        state = model.moved(state, driven[first + step], period_ns * 1e-9)
    error = np.abs(state - seen[first + _AHEAD])
    error = error[np.isfinite(error).all(axis=1)]
    if not len(error):
        return None
    change = np.median(np.abs(seen[first + _AHEAD] - seen[first]), axis=0)
    moved = (float(change[0]), float(change[1]), float(change[2]))
    return Motion(error[:, 0], error[:, 1], np.expm1(error[:, 2]), moved)
