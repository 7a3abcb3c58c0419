"""Messages to and from the learner: it learns from what was perceived and executed, never from what was asked for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from components.learner import ports
from components.learner.frame import Frame, Progress, action_of, percept_of
from components.learner.holding import Holding
from components.learner.join import Join
from components.learner.methods import make_method
from components.learner.transition import Transition
from docking.arrays import pack, unpack
from docking.cells import Grid
from runtime.contract import STOP, Event, Output
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Snapshot
from schemas.trial_pb2 import Trial

_KIND = "learner component"


class Learner:
    """Joins percept, trial and applied command by capture time, cuts them into transitions, learns, publishes.

    A policy follows each frame that completed a transition which counted; a snapshot every so many trials, after the
    last training trial and at the end of the run.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        self._grid = Grid.of(params.task)
        self._method = make_method(params.task, params)
        self._method.plan()  # compiles; of nothing it learns nothing
        self._join = Join(params.join_frames)
        self._holding = Holding(params, self._grid)
        self._version = 0
        self._kept_version = 0
        self._kept_trials = 0

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Take a part of a frame; learn from the frames that are complete."""
        if event.port == STOP:
            return tuple(self._snapshot())
        self._take(event)
        return tuple(output for frame in self._join.ready() for output in self._learn(frame))

    def save(self) -> bytes:
        """Everything."""
        header = {
            "version": self._version,
            "kept_version": self._kept_version,
            "kept_trials": self._kept_trials,
            "join": self._join.to_plain(),
            "hold": self._holding.to_plain(),
        }
        return pack(_KIND, header, {"method": np.frombuffer(self._method.save(), dtype=np.int8)})

    def load(self, state: bytes) -> None:
        """Go on where `save` was called, with the same task and settings; on an error nothing is changed.

        Raises:
            ValueError: it is not such a state; says why.
        """
        header, arrays = unpack(state, _KIND)
        join, holding = Join(self._params.join_frames), Holding(self._params, self._grid)
        try:
            join.from_plain(header["join"])
            holding.from_plain(header["hold"])
            counts = [int(header[name]) for name in ("version", "kept_version", "kept_trials")]
            self._method.load(arrays["method"].tobytes())
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError(f"learner state is incomplete or mistyped: {error!r}") from error
        self._join, self._holding = join, holding
        self._version, self._kept_version, self._kept_trials = counts

    def _take(self, event: Event) -> None:
        message, capture_ns = event.message, event.capture_ns
        if event.port == "percept":
            percept = percept_of(
                self._params, self._grid, message.visible, message.slope, message.pan_rad, message.tilt_rad
            )
            self._join.add(capture_ns, "percept", percept)
        elif event.port == "trial":
            self._join.add(capture_ns, "progress", _progress(message))
        elif event.port == "applied":
            action = action_of(self._params, message.v_mps, message.omega_radps)
            self._join.add(capture_ns, "action", action)

    def _learn(self, frame: Frame) -> Iterator[Output]:
        counted = [self._improve(transition) for transition in self._holding.feed(frame)]
        if any(counted):
            self._version += 1
            yield Output("policy", self._policy(), frame.capture_ns)
        if self._is_due(frame.progress):
            yield from self._snapshot(frame.capture_ns)

    def _improve(self, transition: Transition) -> bool:
        counts = self._method.observe(transition)
        if counts:
            self._method.plan()
        return counts

    def _is_due(self, progress: Progress) -> bool:
        """Whether enough trials have ended since the last snapshot, or the training just has."""
        if not progress.training:
            self._kept_trials = 0
            return True
        due = progress.ended - self._kept_trials >= self._params.snapshot_every_trials
        if due:
            self._kept_trials = progress.ended
        return due

    def _policy(self) -> Policy:
        table = self._method.table(self._version)
        return Policy(
            version=table.version,
            method=table.method,
            beta_cells=table.grid.beta_cells,
            alpha_cells=table.grid.alpha_cells,
            beta_range_rad=table.grid.beta_range_rad,
            alpha_range_rad=table.grid.alpha_range_rad,
            action=table.action.tobytes(),
            value=table.value,
            table_sha256=table.table_sha256,
            transitions=table.transitions,
            action_v_mps=[v for v, _ in table.actions],
            action_omega_radps=[omega for _, omega in table.actions],
        )

    def _snapshot(self, capture_ns: int | None = None) -> Iterator[Output]:
        """The whole state, if it has learned since the last one."""
        if self._version > self._kept_version:
            self._kept_version = self._version
            snapshot = Snapshot(version=self._version, table_sha256=self._method.digest(), state=self.save())
            yield Output("snapshot", snapshot, capture_ns)


def _progress(trial: Any) -> Progress:
    training = trial.phase == Trial.TRAIN
    learning = training and trial.mode == Trial.APPROACH
    return Progress(training=training, learning=learning, began_ns=trial.began_ns, ended=trial.ended)
