"""Messages to and from the learner: it learns from what was perceived and executed, never from what was asked for."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from components.learner import ports
from components.learner.chain import Chain
from components.learner.frame import Frame, Progress, action_of, percept_of
from components.learner.methods import make_method
from components.learner.methods.perceptual import PerceptualMethod
from components.learner.methods.tabular import Tabular
from components.learner.settings import PERCEPTUAL
from components.learner.transition import Transition
from docking.arrays import pack, unpack
from docking.cells import Grid
from docking.grid_policy import GridPolicy
from runtime.contract import STOP, Event, Output
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import LearnerPace, Snapshot
from schemas.trial_pb2 import Trial

_KIND = "learner component"


class Learner:
    """Joins percept, trial and applied command by capture time, cuts them into transitions, learns, publishes.

    Of several robots that share it each has ports of its own; what one has seen, all know. With our own methods each
    has a policy of its own, with the others all have the same. A policy follows each frame that completed a transition
    which counted; a snapshot every so many trials, after the (first robot's) last training trial and at the end of the
    run.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        self._grid = Grid.of(params.task)
        self._method = _method_of(params)
        self._chains = self._new_chains()
        self._version = 0
        self._kept_version = 0
        self._kept_trials = 0

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Take a part of a frame; learn from the frames that are complete."""
        if event.port == STOP:
            return tuple(self._snapshot())
        part, robot = ports.HEARD[event.port]
        self._take(self._chains[robot], part, event)
        return tuple(output for frame in self._chains[robot].join.ready() for output in self._learn(frame, robot))

    def save(self) -> bytes:
        """Everything."""
        return self._state(self._method.save())

    def _state(self, method: bytes) -> bytes:
        header = {
            "version": self._version,
            "kept_version": self._kept_version,
            "kept_trials": self._kept_trials,
            "chains": [chain.to_plain() for chain in self._chains],
        }
        return pack(_KIND, header, {"method": np.frombuffer(method, dtype=np.int8)})

    def load(self, state: bytes) -> None:
        """Go on where `save` was called, with the same task and settings; on an error nothing is changed.

        Raises:
            ValueError: it is not such a state; says why.
        """
        header, arrays = unpack(state, _KIND)
        chains = self._new_chains()
        try:
            for chain, plain in zip(chains, header["chains"], strict=True):
                chain.from_plain(plain)
            counts = [int(header[name]) for name in ("version", "kept_version", "kept_trials")]
            self._method.load(arrays["method"].tobytes())
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError(f"learner state is incomplete or mistyped: {error!r}") from error
        self._chains = chains
        self._version, self._kept_version, self._kept_trials = counts

    def _new_chains(self) -> tuple[Chain, ...]:
        return tuple(Chain.of(self._params, self._grid) for _ in range(ports.FLEET))

    def _take(self, chain: Chain, part: str, event: Event) -> None:
        message, capture_ns, join = event.message, event.capture_ns, chain.join
        if part == "percept":
            percept = percept_of(
                self._params, self._grid, message.visible, message.slope, message.pan_rad, message.tilt_rad
            )
            join.add(capture_ns, "percept", percept)
        elif part == "trial":
            join.add(capture_ns, "progress", _progress(message))
        else:
            action = action_of(self._params, message.v_mps, message.omega_radps)
            join.add(capture_ns, "action", action)
            join.add(capture_ns, "command", (message.v_mps, message.omega_radps))

    def _learn(self, frame: Frame, robot: int) -> Iterator[Output]:
        if self._improve(frame, robot):
            self._version += 1
            yield from (Output(ports.POLICIES[one], self._policy(one), frame.capture_ns) for one in self._told(robot))
        if robot == 0 and self._is_due(frame.progress):
            yield from self._snapshot(frame.capture_ns)
        before_ns, self._chains[robot].newest_ns = self._pace_ns, frame.capture_ns
        if isinstance(self._method, PerceptualMethod) and self._pace_ns > before_ns:
            yield Output("pace", LearnerPace(version=self._version), self._pace_ns)

    @property
    def _pace_ns(self) -> int:
        """Newest frame that was learned from, of the robot that is behind all others; -1 = none has been heard of."""
        return min((chain.newest_ns for chain in self._chains if chain.newest_ns >= 0), default=-1)

    def _improve(self, frame: Frame, robot: int) -> bool:
        """Whether the policy may have changed."""
        if isinstance(self._method, PerceptualMethod):
            return self._method.feed(frame, robot)
        transitions = self._chains[robot].holding.feed(frame)
        counted = [_observed(self._method, transition) for transition in transitions]
        return any(counted)

    def _told(self, robot: int) -> Sequence[int]:
        """The robots whose policy may have changed with a frame of one."""
        if isinstance(self._method, PerceptualMethod):
            return (robot,)
        return [number for number, chain in enumerate(self._chains) if number == robot or chain.newest_ns >= 0]

    def _is_due(self, progress: Progress) -> bool:
        """Whether enough trials have ended since the last snapshot, or the training just has."""
        if not progress.training:
            self._kept_trials = 0
            return True
        due = progress.ended - self._kept_trials >= self._params.snapshot_every_trials
        if due:
            self._kept_trials = progress.ended
        return due

    def _policy(self, robot: int) -> Policy:
        method, version = self._method, self._version
        table = method.table(version, robot) if isinstance(method, PerceptualMethod) else method.table(version)
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
            fine=None if table.fine is None else _fine(table.fine),
        )

    def _snapshot(self, capture_ns: int | None = None) -> Iterator[Output]:
        """All that it knows, if it has learned since the last one."""
        if self._version > self._kept_version:
            self._kept_version = self._version
            method = self._method
            state = self._state(method.knowledge())
            yield Output(
                "snapshot", Snapshot(version=self._version, table_sha256=method.digest(), state=state), capture_ns
            )


def _method_of(params: ports.Params) -> Tabular | PerceptualMethod:
    if params.method in PERCEPTUAL:
        return PerceptualMethod(params.task, params, params.sampling_period_s)
    method = make_method(params.task, params)
    method.plan()  # compiles; of nothing it learns nothing
    return method


def _observed(method: Tabular, transition: Transition) -> bool:
    counts = method.observe(transition)
    if counts:
        method.plan()
    return counts


def _fine(policy: GridPolicy) -> Policy.Fine:
    axes, model = policy.axes, policy.model
    return Policy.Fine(
        beta_range_rad=axes.beta_range_rad,
        alpha_range_rad=axes.alpha_range_rad,
        d_min=axes.d_min,
        d_max=axes.d_max,
        beta_nodes=axes.beta_nodes,
        alpha_nodes=axes.alpha_nodes,
        d_nodes=axes.d_nodes,
        action_zlib=zlib.compress(policy.action.tobytes(), 6),
        docking=policy.docking,
        back_samples=policy.back_samples,
        functions=model.functions,
        theta=model.theta.ravel(),
        delay_samples=model.delay_samples,
        noise=model.noise,
    )


def _progress(trial: Any) -> Progress:
    training = trial.phase == Trial.TRAIN
    learning = training and trial.mode == Trial.APPROACH
    return Progress(training=training, learning=learning, began_ns=trial.began_ns, ended=trial.ended)
