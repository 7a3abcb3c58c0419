"""A log cut into training trials, and each trial into transitions, by the learner's own parts."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from components.learner.frame import Frame, Percept, Progress, action_of, percept_of
from components.learner.holding import Holding
from components.learner.ports import Params
from components.learner.transition import Transition
from docking.cells import SINK, Grid
from experiments.relearning import Inputs
from schemas.trial_pb2 import Trial


@dataclass
class LoggedTrial:
    """One approach."""

    transitions: list[Transition] = field(default_factory=list)
    """In order; those that count and those that do not."""
    frames: int = 0
    """Sampling periods from its first frame to its last."""

    def reached(self, goal: int) -> bool | None:
        """Whether it ended in the goal cell (True) or in the sink (False); None if it ended otherwise."""
        if not self.transitions:
            return None
        last = self.transitions[-1].next_cell
        return last == goal if last in (goal, SINK) else None


def trials_of(params: Params, inputs: Inputs) -> list[LoggedTrial]:
    """The training trials that have transitions, in order."""
    grid = Grid.of(params.task)
    holding = Holding(params, grid)
    found: list[LoggedTrial] = []
    for _, frames in itertools.groupby(_frames(params, grid, inputs), lambda frame: frame.progress.began_ns):
        trial = LoggedTrial()
        for frame in frames:
            trial.frames += frame.progress.learning
            trial.transitions += holding.feed(frame)
        if trial.transitions:
            found.append(trial)
    return found


def _frames(params: Params, grid: Grid, inputs: Inputs) -> Iterator[Frame]:
    """Frames all of whose parts are there, by capture time."""
    parts: dict[int, dict[str, Any]] = {}
    for port, message, capture_ns, _ in inputs:
        part = parts.setdefault(capture_ns, {})
        if port == "percept":
            part["percept"] = _percept(params, grid, message)
        elif port == "trial":
            part["progress"] = _progress(message)
        elif port == "applied":
            part["action"] = action_of(params, message.v_mps, message.omega_radps)
    return (Frame(at_ns, **part) for at_ns, part in sorted(parts.items()) if len(part) == 3)


def _percept(params: Params, grid: Grid, message: Any) -> Percept:
    return percept_of(params, grid, message.visible, message.slope, message.pan_rad, message.tilt_rad)


def _progress(message: Any) -> Progress:
    training = message.phase == Trial.TRAIN
    return Progress(training, training and message.mode == Trial.APPROACH, message.began_ns, message.ended)
