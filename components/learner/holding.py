"""Cuts the stream of frames into transitions: from entering a cell to having changed it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from components.learner.frame import UNKNOWN_ACTION, Frame
from components.learner.ports import Params
from components.learner.transition import Transition
from docking.cells import SINK, Grid

_NS = 1_000_000_000


@dataclass
class Hold:
    """An action being held. Times are capture times."""

    cell: int
    began_ns: int
    trial_ns: int
    """When the trial began: its name."""
    previous_action: int
    """Of the hold before, UNKNOWN_ACTION at the start of a trial."""
    beta_rad: float
    """State from which motion is measured: where the action came into force."""
    alpha_rad: float
    motion_ns: int
    newest_ns: int
    frames: int
    votes: list[int]
    """Frames in which each action was executed; the last entry counts the unknown ones."""


class Holding:
    """`feed` it every frame in order; it gives a transition when one is complete.

    The action of a transition is the one executed in most of its frames. Where the action has just changed, the first
    `delay_samples` of the motion still belong to the one before and are left out.
    """

    def __init__(self, params: Params, grid: Grid) -> None:
        self._params = params
        self._grid = grid
        self._period_ns = round(params.sampling_period_s * _NS)
        self._hold: Hold | None = None

    def feed(self, frame: Frame) -> Transition | None:
        """One frame; None while no transition is complete."""
        hold, percept = self._hold, frame.percept
        if not (frame.progress.learning and percept.visible):
            self._hold = None
            return None
        if hold is not None and self._is_broken(hold, frame):
            hold = self._hold = None
        if hold is not None and not self._is_over(hold, frame):
            self._go_on(hold, frame)
            return None
        transition = None if hold is None else self._transition(hold, frame)
        self._hold = None
        if percept.cell not in (SINK, self._grid.goal) and not percept.too_close:
            self._begin(frame, UNKNOWN_ACTION if hold is None else _winner(hold))
        return transition

    def to_plain(self) -> dict[str, Any] | None:
        """As JSON can say it."""
        return None if self._hold is None else asdict(self._hold)

    def from_plain(self, plain: dict[str, Any] | None) -> None:
        """Take over what `to_plain` gave.

        Raises:
            TypeError, ValueError: it is nothing of the kind.
        """
        hold = None if plain is None else Hold(**plain)
        if hold is not None and (len(hold.votes) != len(self._params.task.actions) + 1 or hold.cell < 0):
            raise ValueError("the held action must be one of the task's, in a cell")
        self._hold = hold

    def _begin(self, frame: Frame, previous_action: int) -> None:
        percept = frame.percept
        self._hold = Hold(
            cell=percept.cell,
            began_ns=frame.capture_ns,
            trial_ns=frame.progress.began_ns,
            previous_action=previous_action,
            beta_rad=percept.beta_rad,
            alpha_rad=percept.alpha_rad,
            motion_ns=frame.capture_ns,
            newest_ns=frame.capture_ns,
            frames=0,
            votes=[0] * (len(self._params.task.actions) + 1),
        )
        self._vote(self._hold, frame)

    def _go_on(self, hold: Hold, frame: Frame) -> None:
        if hold.frames <= self._params.delay_samples and _winner(hold) != hold.previous_action:
            hold.beta_rad, hold.alpha_rad = frame.percept.beta_rad, frame.percept.alpha_rad
            hold.motion_ns = frame.capture_ns
        hold.newest_ns = frame.capture_ns
        self._vote(hold, frame)

    def _vote(self, hold: Hold, frame: Frame) -> None:
        hold.frames += 1
        hold.votes[frame.action] += 1  # UNKNOWN_ACTION is the last

    def _is_broken(self, hold: Hold, frame: Frame) -> bool:
        """Another trial, or frames are missing."""
        gap_ns = frame.capture_ns - hold.newest_ns
        return hold.trial_ns != frame.progress.began_ns or gap_ns > self._params.max_gap_samples * self._period_ns

    def _is_over(self, hold: Hold, frame: Frame) -> bool:
        percept, params = frame.percept, self._params
        if percept.cell in (SINK, self._grid.goal) or percept.too_close:
            return True
        if params.hold_periods:
            return frame.capture_ns - hold.began_ns >= (params.hold_periods - 0.5) * self._period_ns
        return self._grid.distance(hold.cell, percept.cell) >= params.adjoining_cells

    def _transition(self, hold: Hold, frame: Frame) -> Transition | None:
        action, percept = _winner(hold), frame.percept
        if action == UNKNOWN_ACTION or hold.votes[action] < self._params.action_share * hold.frames:
            return None
        return Transition(
            cell=hold.cell,
            action=action,
            next_cell=SINK if percept.too_close else percept.cell,
            periods=(frame.capture_ns - hold.began_ns) / self._period_ns,
            beta_change_rad=percept.beta_rad - hold.beta_rad,
            alpha_change_rad=percept.alpha_rad - hold.alpha_rad,
            motion_periods=(frame.capture_ns - hold.motion_ns) / self._period_ns,
            too_close=percept.too_close,
        )


def _winner(hold: Hold) -> int:
    """The action executed in most frames; UNKNOWN_ACTION if none of the task's was."""
    known = hold.votes[:-1]
    return known.index(max(known)) if any(known) else UNKNOWN_ACTION
