"""Cuts the stream of frames into transitions: from entering a cell to having changed it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from components.learner.frame import UNKNOWN_ACTION, Frame, frame_of
from components.learner.ports import Params
from components.learner.transition import Transition
from docking.cells import SINK, Grid

_NS = 1_000_000_000


@dataclass
class Hold:
    """An action being held. Times are capture times."""

    cell: int
    began_ns: int
    beta_rad: float
    """State when the action came into force, and when that was."""
    alpha_rad: float
    motion_ns: int
    frames: int
    votes: list[int]
    """Frames in which each action was executed; the last entry counts the unknown ones."""


class Holding:
    """`feed` it every frame in order; it gives the transitions that are complete.

    The action of a transition is the one executed in most of its frames. Its motion is measured `delay_samples` after
    its frames, when that action was in force. That also frees the motion from the percept's noise: the frames in which
    the cell changes are those whose noise helped it to change, the ones after them are like any others.
    """

    def __init__(self, params: Params, grid: Grid) -> None:
        self._params = params
        self._grid = grid
        self._period_ns = round(params.sampling_period_s * _NS)
        self._hold: Hold | None = None
        self._late: list[Frame] = []
        """Frames whose motion is still to come, at most `delay_samples`."""
        self._newest: Frame | None = None

    def feed(self, frame: Frame) -> tuple[Transition, ...]:
        """One frame; the transitions that it completes, at most as many as frames were late."""
        if not (frame.progress.learning and frame.percept.visible):
            return self._flush()
        complete = self._flush() if self._is_broken(frame) else ()
        self._newest = frame
        self._late.append(frame)
        if self._is_end(frame):
            return (*complete, *self._flush())
        if len(self._late) <= self._params.delay_samples:
            return complete
        transition = self._step(self._late.pop(0), frame)
        return complete if transition is None else (*complete, transition)

    def to_plain(self) -> dict[str, Any]:
        """As JSON can say it."""
        hold = None if self._hold is None else asdict(self._hold)
        return {"hold": hold, "late": self._late, "newest": self._newest}

    def from_plain(self, plain: dict[str, Any]) -> None:
        """Take over what `to_plain` gave.

        Raises:
            KeyError, TypeError, ValueError: it is nothing of the kind.
        """
        hold = None if plain["hold"] is None else Hold(**plain["hold"])
        late = [frame_of(row) for row in plain["late"]]
        newest = None if plain["newest"] is None else frame_of(plain["newest"])
        if hold is not None and (len(hold.votes) != len(self._params.task.actions) + 1 or hold.cell < 0):
            raise ValueError("the held action must be one of the task's, in a cell")
        if len(late) > self._params.delay_samples:
            raise ValueError("more frames are late than the delay allows")
        self._hold, self._late, self._newest = hold, late, newest

    def _flush(self) -> tuple[Transition, ...]:
        """The trial has ended: no more motion will come than was seen."""
        found = [self._step(frame, self._newest or frame) for frame in self._late]
        self._hold, self._late, self._newest = None, [], None
        return tuple(transition for transition in found if transition is not None)

    def _step(self, frame: Frame, moved: Frame) -> Transition | None:
        """One frame and the later one that shows its motion."""
        hold = self._hold
        if hold is not None and not self._is_over(hold, frame):
            _vote(hold, frame)
            return None
        transition = None if hold is None else self._transition(hold, frame, moved)
        self._hold = None
        if not self._is_end(frame):
            self._hold = self._begun(frame, moved)
            _vote(self._hold, frame)
        return transition

    def _begun(self, frame: Frame, moved: Frame) -> Hold:
        return Hold(
            cell=frame.percept.cell,
            began_ns=frame.capture_ns,
            beta_rad=moved.percept.beta_rad,
            alpha_rad=moved.percept.alpha_rad,
            motion_ns=moved.capture_ns,
            frames=0,
            votes=[0] * (len(self._params.task.actions) + 1),
        )

    def _is_broken(self, frame: Frame) -> bool:
        """Another trial, or frames are missing."""
        newest = self._newest
        if newest is None:
            return False
        gap_ns = frame.capture_ns - newest.capture_ns
        another = newest.progress.began_ns != frame.progress.began_ns
        return another or gap_ns > self._params.max_gap_samples * self._period_ns

    def _is_end(self, frame: Frame) -> bool:
        return frame.percept.too_close or frame.percept.cell in (SINK, self._grid.goal)

    def _is_over(self, hold: Hold, frame: Frame) -> bool:
        params = self._params
        if self._is_end(frame):
            return True
        if params.hold_periods:
            return frame.capture_ns - hold.began_ns >= (params.hold_periods - 0.5) * self._period_ns
        return self._grid.distance(hold.cell, frame.percept.cell) >= params.adjoining_cells

    def _transition(self, hold: Hold, frame: Frame, moved: Frame) -> Transition | None:
        action, percept = _winner(hold), frame.percept
        motion_ns = moved.capture_ns - hold.motion_ns
        clear = hold.votes[action] >= self._params.action_share * hold.frames
        if action == UNKNOWN_ACTION or motion_ns <= 0 or not clear:
            return None
        return Transition(
            cell=hold.cell,
            action=action,
            next_cell=SINK if percept.too_close else percept.cell,
            periods=(frame.capture_ns - hold.began_ns) / self._period_ns,
            beta_change_rad=moved.percept.beta_rad - hold.beta_rad,
            alpha_change_rad=moved.percept.alpha_rad - hold.alpha_rad,
            motion_periods=motion_ns / self._period_ns,
            too_close=percept.too_close,
        )


def _vote(hold: Hold, frame: Frame) -> None:
    hold.frames += 1
    hold.votes[frame.action] += 1  # UNKNOWN_ACTION is the last


def _winner(hold: Hold) -> int:
    """The action executed in most frames; UNKNOWN_ACTION if none of the task's was."""
    known = hold.votes[:-1]
    return known.index(max(known)) if any(known) else UNKNOWN_ACTION
