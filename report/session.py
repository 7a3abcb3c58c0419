"""Everything the report needs, read from a session's file in one pass."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from docking.angles import wrap
from docking.score import Trial
from report.failures import Endings, Failed
from report.fit import Fit, FitReader
from report.frames import Scoreboard, is_sane
from report.incidents import Incident, Incidents, commanders_of
from report.latency import Hop, Latency
from report.pairs import Pairs
from report.policies import is_policy
from report.shadow import Beside, ShadowReader, task_of
from report.told import Told
from runtime.mcap_items import Fault
from runtime.params import ConfigurationError
from runtime.recording import Logged, Recording, Tallies, Topic
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial as TrialMessage
from schemas.truth_pb2 import Truth


@dataclass
class Session:
    """A session as the report sees it."""

    file: Path
    metadata: Mapping[str, str]
    launch: Mapping[str, Any]
    whole: bool
    trials: list[Trial] = field(default_factory=list)
    failed: list[Failed] = field(default_factory=list)
    """Trials that failed, as the pilot names it."""
    shadow: Mapping[str, Any] = field(default_factory=dict)
    """How a shadow compares with who drove; empty without one."""
    beside: list[Beside] = field(default_factory=list)
    """Frames in which a shadow had a word to say."""
    knows_truth: bool = True
    """Trials are judged by the truth; else they are what the robot itself tells, lengths in camera heights."""
    incidents: list[Incident] = field(default_factory=list)
    """What went wrong in the machinery."""
    hops: list[Hop] = field(default_factory=list)
    """How old frames are on their way; empty in lockstep."""
    fit: Fit = field(default_factory=Fit)
    """How well what was learned predicts."""
    topics: list[Topic] = field(default_factory=list)
    """Messages of each topic and run."""
    damage: list[Fault] = field(default_factory=list)
    """What of the file can not be read."""
    collisions: int = 0
    robot_s: float = 0.0
    tracking_px: list[float] = field(default_factory=list)
    """Residual of the can from the image centre, per visible frame."""
    bearing_error_rad: list[float] = field(default_factory=list)
    policies: list[tuple[float, Policy]] = field(default_factory=list)
    """(robot seconds, table): the newest of each robot minute."""
    pictures: dict[str, bytes] = field(default_factory=dict)
    """Mode of the pilot -> the newest camera image in it."""

    @property
    def messages(self) -> int:
        """Of all topics."""
        return sum(topic.count for topic in self.topics)

    @property
    def lost(self) -> int:
        """Messages that are missing in their sequences."""
        return sum(topic.lost for topic in self.topics)

    @property
    def counts(self) -> dict[str, int]:
        """Messages per topic, of all runs."""
        found: dict[str, int] = {}
        for topic in self.topics:
            found[topic.topic] = found.get(topic.topic, 0) + topic.count
        return found

    def of_phase(self, phase: str) -> list[Trial]:
        """Trials of TRAIN or EVALUATE."""
        return [trial for trial in self.trials if trial.phase == phase]


def read(file: Path) -> Session:
    """Read a session.

    Raises:
        ConfigurationError: not an MCAP file, or no session of ours.
    """
    recording = Recording(file)
    launch = recording.launch()
    if not launch:
        raise ConfigurationError(f"{file}: must be a session of ours; it holds no launch file")
    session = Session(file, recording.session(), launch, recording.whole())
    _Reader(session).read(recording)
    return session


_IMAGE = "foxglove.CompressedImage"
Taker = Callable[[Logged, Any], None]
"""Takes a message and what it decodes to."""


class _Reader:
    """One pass over the file; the topics come from the session's own launch file."""

    def __init__(self, session: Session) -> None:
        self._session = session
        task = task_of(session.launch)
        self._board, self._told = Scoreboard(), Told(task)
        self._endings = Endings()
        self._incidents = Incidents(commanders_of(session.launch))
        self._latency = Latency(session.launch)
        self._fit = FitReader(session.launch, task)
        self._shadow = ShadowReader(session.launch)
        self._offset = task.offset
        self._pairs: Pairs[Percept, Truth] = Pairs()
        self._image: Logged | None = None
        self._images: dict[str, Logged] = {}
        self._policies: dict[int, Logged] = {}
        self._trial, self._truth = (str(session.launch.get(name, "")) for name in ("trial", "truth"))

    def read(self, recording: Recording) -> None:
        """Fill the session."""
        tallies, takers = Tallies(), dict[tuple[str, str], tuple[Taker, ...]]()
        remember = None if self._latency.is_lockstep else self._latency.take
        for logged in recording.messages(faults=self._session.damage):
            tallies.add(logged)
            if remember is not None:
                remember(logged)
            if logged.schema == _IMAGE:
                self._image = logged
                continue
            kind = (logged.topic, logged.schema)
            if kind not in takers:
                takers[kind] = tuple(self._takers(*kind))
            if takers[kind] and (message := logged.decoded()) is not None:
                for take in takers[kind]:
                    take(logged, message)
        self._session.topics = tallies.topics()
        self._session.knows_truth = any(topic.topic == self._truth for topic in self._session.topics)
        if not self._session.knows_truth:
            self._listen(recording)
        self._fill()

    def _listen(self, recording: Recording) -> None:
        """Again, to what the robot itself tells."""
        percepts = {topic.topic for topic in self._session.topics if topic.schema == "berth.Percept"}
        for logged in recording.messages({self._trial, *percepts}):
            message = logged.decoded()
            if isinstance(message, Percept) or (isinstance(message, TrialMessage) and is_sane(message)):
                self._told.take(message, logged.capture_ns)

    def _takers(self, topic: str, schema: str) -> Iterator[Taker]:
        """Who wants the messages of a topic."""
        if schema == "berth.Policy":
            yield self._take_policy
        elif topic == self._trial and schema == "berth.Trial":
            yield self._take_trial
        elif topic == self._truth and schema == "berth.Truth":
            yield self._take_truth
        elif schema == "berth.Percept":
            yield self._take_percept
        elif schema == "berth.Applied":
            yield lambda logged, message: self._fit.take_applied(message, logged.capture_ns)
        if self._incidents.wants(schema):
            yield self._incidents.take
        if self._shadow.wants(topic):
            yield self._shadow.take

    def _take_policy(self, logged: Logged, _: Policy) -> None:
        self._policies[logged.capture_ns // 60_000_000_000] = logged
        self._fit.take_policy(logged)

    def _take_trial(self, logged: Logged, message: TrialMessage) -> None:
        if not is_sane(message):
            return
        self._board.take(message, logged.capture_ns)
        self._fit.take(message, logged.capture_ns)
        self._endings.take(message, logged.capture_ns)
        if self._image is not None:
            self._images[TrialMessage.Mode.Name(message.mode)] = self._image

    def _take_truth(self, logged: Logged, message: Truth) -> None:
        if is_sane(message):
            self._board.take(message, logged.capture_ns)
            self._compare(self._pairs.second(logged.capture_ns, message))

    def _take_percept(self, logged: Logged, message: Percept) -> None:
        self._fit.take(message, logged.capture_ns)
        self._compare(self._pairs.first(logged.capture_ns, message))

    def _compare(self, pair: tuple[Percept, Truth] | None) -> None:
        if pair is None:
            return
        percept, truth = pair
        if percept.visible and math.isfinite(percept.pan_rad) and math.isfinite(percept.tilt_rad):
            self._session.tracking_px.append(math.hypot(truth.object_u_px, truth.object_v_px))
            alpha_rad = self._offset.from_axle(percept.pan_rad, percept.tilt_rad).alpha_rad
            self._session.bearing_error_rad.append(abs(wrap(alpha_rad - truth.alpha_rad)))

    def _fill(self) -> None:
        session, scorer = self._session, self._board.scorer
        session.trials = scorer.trials if session.knows_truth else self._told.trials()
        session.collisions, session.robot_s = scorer.collisions, self._board.robot_s
        session.failed, session.incidents = self._endings.failed, self._incidents.found
        session.shadow, session.beside = self._shadow.table(), self._shadow.frames
        session.hops, session.fit = self._latency.hops(), self._fit.fit()
        images = {mode: logged.decoded() for mode, logged in self._images.items()}
        session.pictures = {mode: image.data for mode, image in images.items() if image is not None}
        policies = [(logged.capture_ns * 1e-9, logged.decoded()) for logged in self._policies.values()]
        session.policies = [(at_s, policy) for at_s, policy in policies if is_policy(policy)]


def resolved(session: Session) -> str:
    """The resolved launch file, for people."""
    return json.dumps(session.launch, indent=1, sort_keys=True)
