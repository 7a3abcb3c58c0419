"""Everything the report needs, read from a session's file in one pass."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from components.pilot.messages import table_of
from docking.angles import wrap
from docking.score import Trial
from report.failures import Endings, Failed
from report.frames import Scoreboard, is_sane
from report.pairs import Pairs
from report.shadow import Beside, ShadowReader, task_of
from runtime.params import ConfigurationError
from runtime.recording import Logged, Recording
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
    collisions: int = 0
    robot_s: float = 0.0
    messages: int = 0
    lost: int = 0
    counts: dict[str, int] = field(default_factory=dict)
    """Messages per topic."""
    tracking_px: list[float] = field(default_factory=list)
    """Residual of the can from the image centre, per visible frame."""
    bearing_error_rad: list[float] = field(default_factory=list)
    policies: list[tuple[float, Policy]] = field(default_factory=list)
    """(robot seconds, table): the newest of each robot minute."""
    pictures: dict[str, bytes] = field(default_factory=dict)
    """Mode of the pilot -> the newest camera image in it."""

    def launch_number(self, component: str, name: str, default: float) -> float:
        """A component's parameter; the default if the launch file, which may be anybody's, holds no such number."""
        specs = self.launch.get("components")
        for spec in specs if isinstance(specs, list) else ():
            if isinstance(spec, dict) and spec.get("name") == component and isinstance(spec.get("params"), dict):
                value = spec["params"].get(name)
                return float(value) if isinstance(value, int | float) and math.isfinite(value) else default
        return default


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


class _Reader:
    """One pass over the file; the topics come from the session's own launch file."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._board = Scoreboard()
        self._endings = Endings()
        self._shadow = ShadowReader(session.launch)
        self._offset = task_of(session.launch).offset
        self._next: dict[tuple[str, int], int] = {}
        self._pairs: Pairs[Percept, Truth] = Pairs()
        self._image: Logged | None = None
        self._images: dict[str, Logged] = {}
        self._policies: dict[int, Logged] = {}
        self._keys = {str(session.launch.get(name, "")) for name in ("trial", "truth")}

    def read(self, recording: Recording) -> None:
        """Fill the session."""
        for logged in recording.messages():
            self._count(logged)
            self._shadow.take(logged)
            if logged.topic in self._keys:
                self._score(logged)
            elif logged.schema == "foxglove.CompressedImage":
                self._image = logged
            elif logged.schema == "berth.Policy":
                self._policies[logged.capture_ns // 60_000_000_000] = logged
            elif logged.schema == "berth.Percept" and (percept := logged.decoded()) is not None:
                self._compare(self._pairs.first(logged.capture_ns, percept))
        session, scorer = self._session, self._board.scorer
        session.trials, session.collisions, session.robot_s = scorer.trials, scorer.collisions, self._board.robot_s
        session.failed, session.shadow, session.beside = (
            self._endings.failed,
            self._shadow.table(),
            self._shadow.frames,
        )
        images = {mode: logged.decoded() for mode, logged in self._images.items()}
        session.pictures = {mode: image.data for mode, image in images.items() if image is not None}
        policies = [(logged.capture_ns * 1e-9, logged.decoded()) for logged in self._policies.values()]
        session.policies = [(at_s, policy) for at_s, policy in policies if _is_policy(policy)]

    def _count(self, logged: Logged) -> None:
        session, key = self._session, (logged.topic, logged.run)
        session.messages += 1
        session.counts[logged.topic] = session.counts.get(logged.topic, 0) + 1
        session.lost += max(0, logged.sequence - self._next.get(key, logged.sequence))
        self._next[key] = logged.sequence + 1

    def _score(self, logged: Logged) -> None:
        message = logged.decoded()
        if message is None or not is_sane(message):
            return
        self._board.take(message, logged.capture_ns)
        if isinstance(message, TrialMessage):
            self._endings.take(message, logged.capture_ns)
        if isinstance(message, Truth):
            self._compare(self._pairs.second(logged.capture_ns, message))
        elif self._image is not None:
            self._images[TrialMessage.Mode.Name(message.mode)] = self._image

    def _compare(self, pair: tuple[Percept, Truth] | None) -> None:
        if pair is None:
            return
        percept, truth = pair
        if percept.visible and math.isfinite(percept.pan_rad) and math.isfinite(percept.tilt_rad):
            self._session.tracking_px.append(math.hypot(truth.object_u_px, truth.object_v_px))
            alpha_rad = self._offset.from_axle(percept.pan_rad, percept.tilt_rad).alpha_rad
            self._session.bearing_error_rad.append(abs(wrap(alpha_rad - truth.alpha_rad)))


def _is_policy(message: Policy | None) -> bool:
    """Whether a policy is one that the pilot would take."""
    try:
        return message is not None and table_of(message) is not None
    except ValueError:
        return False


def resolved(session: Session) -> str:
    """The resolved launch file, for people."""
    return json.dumps(session.launch, indent=1, sort_keys=True)
