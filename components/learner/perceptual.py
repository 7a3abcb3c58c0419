"""Our own learner: rates of the percept under a command, regressed from whole trials, and a plan made with them."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.learner.explorer import trusted_actions
from components.learner.model import checked
from components.learner.motion_memory import MotionMemory
from components.learner.planner import Planner, axes_of
from components.learner.structure import STRUCTURES
from docking.grid_policy import UNKNOWN, GridPolicy, lowest
from docking.levels import Limits
from docking.rates import RateModel
from docking.value_iteration import LATE_S

Floats = NDArray[np.float64]
Actions = tuple[tuple[float, float], ...]
LONGEST_STRETCH = 200
"""Frames of all robots that are built alike; 25 s. A longer way is learned from in parts."""


@dataclass(frozen=True)
class Planning:
    """How finely is planned, and how much is trusted."""

    method: str = "structure-given"
    """Key of `components.learner.structure.STRUCTURES`."""
    period_s: float = 0.125
    angle_step_rad: float = 0.026
    """Spacing of the grid's nodes in beta and alpha."""
    d_share: float = 0.107
    """Spacing of the grid's nodes in d, as a share of the goal's distance."""
    memory_s: float = 600.0
    """Time constant of forgetting."""
    surprise: float = 9.0
    """A stretch of frames whose mean square error is so many times the expected one makes it forget what was before,
    and so do smaller errors that last."""
    trust_per_s: float = 0.3
    """Standard deviation of the rates, in rad/s and shares of the distance per second, up to which they are trusted."""
    known_per_s: float = 0.03
    """As above, up to which nothing more has to be learned of them."""
    replan_per_s: float = 0.005
    """No new plan is made for rates that differ by less, rad/s and camera heights per second."""
    back_samples: int = 0
    """Driving backwards is planned to be done for so many periods at a time; 0 = as any other action."""
    explore: bool = True
    """In training the least known action is tried where that is safe. Where the rates are not trusted, and nothing is
    to be tried, the linear controller drives."""


class Seen(NamedTuple):
    """One frame."""

    state: tuple[float, float, float]
    """beta, alpha (rad) relative to the goal, ln of the distance in camera heights."""
    command: tuple[float, float]
    """Executed from this frame on: m/s, rad/s."""


@dataclass
class OpenStretch:
    """Frames in a row that are still to be learned from."""

    frames: list[Seen] = field(default_factory=list)
    stage: int = -1
    """Names the trial, or the way back."""


class Perceptual:
    """Of one robot: `feed` it every frame in order; `advance` lets it plan; `policy` is what came of it.

    Frames in a row are one stretch; it ends where the robot changes between approaching and driving back, where the
    object is not seen, and after `LONGEST_STRETCH` frames. Then it is learned from, and a new plan begins.

    Args:
        alike: the learner of a robot that is built alike: what one has seen, all know.
    """

    def __init__(self, planning: Planning, limits: Limits, actions: Actions, alike: Perceptual | None = None) -> None:
        self.planning, self.actions = planning, actions
        kin: list[MotionMemory] = [] if alike is None else alike.memory.alike
        self.memory: MotionMemory = MotionMemory(
            STRUCTURES[planning.method], planning.period_s, planning.memory_s, planning.surprise, kin
        )
        axes = axes_of(limits, planning.angle_step_rad, planning.d_share * limits.gripper_m)
        back_s = planning.back_samples * planning.period_s
        self.planner = Planner(limits, axes, np.array(actions), planning.period_s, back_s)
        self.table = np.full(axes.shape, UNKNOWN, dtype=np.int8)
        self.half_seconds = np.full(axes.shape, round(2 * LATE_S), dtype=np.int8)
        self._open = OpenStretch()
        self._unsure = True
        self._fresh = False
        """Something was learned since the newest plan began."""

    def feed(self, seen: Seen | None, stage: int) -> bool:
        """One frame, None where the object was not seen; the stage names the trial, or the way back.

        Returns:
            Whether so much was learned that a new plan has begun.
        """
        longest = LONGEST_STRETCH // len(self.memory.alike)
        ends = seen is None or stage != self._open.stage or len(self._open.frames) >= longest
        learned = self.close() if ends else False
        self._open.stage = stage
        if seen is not None:
            self._open.frames.append(seen)
        return learned

    def close(self) -> bool:
        """Learn from the stretch that is open; True if a new plan has begun."""
        stretch, self._open.frames = self._open.frames, []
        states = np.array([seen.state for seen in stretch]).reshape(-1, 3)
        commands = np.array([seen.command for seen in stretch]).reshape(-1, 2)
        learned = self.memory.learn(states, commands)
        self._fresh = self._fresh or learned
        return self._begin()

    def _begin(self) -> bool:
        """Begin a new plan if it is worth it, once one that has begun is made: some take longer than a stretch.

        Returns:
            Whether one has begun.
        """
        model = self.memory.model if self._fresh and not self.planner.busy else None
        if model is None:
            return False
        self._fresh = False
        if self._is_planned(model):
            return False
        self.planner.begin(model)
        return True

    def _is_planned(self, model: RateModel) -> bool:
        """Whether the plan was made with nearly the same rates, and with none that were not trusted."""
        if self.planner.model is None or self._unsure:
            return False
        change = self.planner.moves(1.0, model) - self.planner.moves(1.0)
        return bool(np.abs(change).max() < self.planning.replan_per_s)

    def advance(self, layers: int) -> bool:
        """Plan on, by at most so many layers of the grid; True when a plan has just become complete."""
        if not self.planner.busy or not self.planner.advance(layers):
            return False
        fit = self.memory.fit  # only now: of robots that share, every lesson of one changes the fits of all
        if fit is None:
            return False
        planning = self.planning
        self.half_seconds[...] = np.ceil(2.0 * np.minimum(self.planner.times_s, LATE_S))
        self.table, self._unsure = trusted_actions(
            self.planner, fit, planning.trust_per_s, planning.known_per_s, explore=planning.explore
        )
        self._begin()
        return True

    def policy(self, version: int = 0) -> GridPolicy | None:
        """The newest complete plan, with the newest rates; None before the first."""
        model = self.memory.model
        if model is None or not (self.table != UNKNOWN).any():
            return None
        return GridPolicy(
            axes=self.planner.axes,
            action=self.table,
            actions=self.actions,
            model=model,
            docking=self.planner.limits.docking,
            back_samples=self.planning.back_samples,
            version=version,
            method=self.planning.method,
            samples=self.memory.samples,
            table_sha256=self.digest(),
        )

    def to_plain(self, *, plan: bool = True) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Header and arrays for `docking.arrays.pack`; a plan that is being made is most of it, and can be left out."""
        planned = self.planner.model
        header = {
            "open": [self._open.stage, [[*seen.state, *seen.command] for seen in self._open.frames]],
            "unsure": self._unsure,
            "fresh": self._fresh,
            **self.memory.to_plain(),
            "planner": self.planner.to_plain(),
            "planned": None if planned is None else [planned.functions, planned.delay_samples, list(planned.noise)],
        }
        arrays: dict[str, NDArray[Any]] = {
            **self.memory.sums.arrays(),
            "table": self.table,
            "half_seconds": self.half_seconds,
        }
        if planned is not None:
            arrays["planned"] = planned.theta
        if self.planner.busy and plan:
            arrays["times_s"] = self.planner.times_s
        return header, arrays

    def from_plain(self, header: dict[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Take over what `to_plain` gave; a plan that was left out is begun anew. On an error nothing is changed.

        Raises:
            ValueError: it is nothing of the kind; says why.
        """
        sums = {name: checked(arrays, name, own) for name, own in self.memory.sums.arrays().items()}
        table = checked(arrays, "table", self.table)
        half_seconds = checked(arrays, "half_seconds", self.half_seconds)
        least = lowest(len(self.actions))
        if not ((table >= least) & (table < len(self.actions))).all():
            raise ValueError(f"table must be in {least}..{len(self.actions) - 1}")
        try:
            stage, rows = header["open"]
            opened = OpenStretch([*map(_seen, rows)], int(stage))
            unsure, fresh = (bool(header[name]) for name in ("unsure", "fresh"))
            planned = None if header["planned"] is None else _model(header["planned"], arrays)
            place = {key: float(header["planner"][key]) for key in self.planner.to_plain()}
            times_s = checked(arrays, "times_s", self.planner.times_s) if "times_s" in arrays else self.planner.times_s
            self.memory.take_over(sums, header)
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError(f"learner state is incomplete or mistyped: {error!r}") from error
        self.table, self.half_seconds = table, half_seconds
        self._open, self._unsure, self._fresh = opened, unsure, fresh
        if planned is not None and place["busy"] and "times_s" not in arrays:
            self.planner.begin(planned)
        elif planned is not None:
            self.planner.restore(planned, times_s, place)

    def digest(self) -> bytes:
        """SHA-256 of the table of actions and of the sums behind the rates."""
        sums = b"".join(array.astype("<f8").tobytes() for array in self.memory.sums.arrays().values())
        return hashlib.sha256(self.table.tobytes() + sums).digest()


def _seen(row: Any) -> Seen:
    beta, alpha, log, v, omega = map(float, row)
    return Seen((beta, alpha, log), (v, omega))


def _model(described: Any, arrays: Mapping[str, NDArray[Any]]) -> RateModel:
    functions, delay, noise = described
    beta, alpha, log = map(float, noise)
    return RateModel(str(functions), np.asarray(arrays["planned"], dtype=np.float64), float(delay), (beta, alpha, log))
