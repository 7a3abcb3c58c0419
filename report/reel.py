"""A session as a film needs it: what each frame was, in order, and the images of a few of them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from docking.score import Frame, Scorer, Trial
from report.frames import is_sane, joined
from report.pairs import Pairs
from report.policies import is_policy
from runtime.params import ConfigurationError
from runtime.recording import Recording
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial as TrialMessage
from schemas.truth_pb2 import Truth
from schemas.view_pb2 import View

IMAGE, VIEW, POLICY = "foxglove.CompressedImage", "berth.View", "berth.Policy"
POLICY_S = 2.0
"""The newest policy of each span of so many seconds is kept."""


class Moment(NamedTuple):
    """One frame of the session."""

    capture_ns: int
    frame: Frame
    trials: int
    """Trials that have ended, this one's included."""


@dataclass
class Reel:
    """What is read of a session; images are read when they are asked for."""

    recording: Recording
    launch: Mapping[str, Any]
    moments: list[Moment] = field(default_factory=list)
    trials: list[Trial] = field(default_factory=list)
    views: dict[int, View] = field(default_factory=dict)
    """By capture time."""
    policies: list[tuple[float, Policy]] = field(default_factory=list)
    """(session seconds, policy), in order."""

    def images(self, captures_ns: Collection[int]) -> dict[int, bytes]:
        """The camera's JPEG of each of these frames that has one."""
        wanted = frozenset(captures_ns)
        found = self.recording.messages(_topics(self.recording, IMAGE))
        messages = {logged.capture_ns: logged.decoded() for logged in found if logged.capture_ns in wanted}
        return {capture_ns: message.data for capture_ns, message in messages.items() if message is not None}


def read(file: Path) -> Reel:
    """Read a session.

    Raises:
        ConfigurationError: no session of ours, or nothing in it says where the robot was.
    """
    recording = Recording(file)
    launch = recording.launch()
    keys = [str(launch.get(name) or "") for name in ("trial", "truth")]
    reel = Reel(recording, launch)
    scorer, pairs = Scorer(), Pairs[TrialMessage, Truth]()
    newest: dict[int, tuple[float, Policy]] = {}
    for logged in recording.messages([*keys, *_topics(recording, VIEW, POLICY)]):
        message = logged.decoded()
        if isinstance(message, View):
            reel.views[logged.capture_ns] = message
        elif isinstance(message, Policy) and is_policy(message):
            at_s = logged.capture_ns * 1e-9
            newest[int(at_s / POLICY_S)] = (at_s, message)
        elif isinstance(message, TrialMessage | Truth) and is_sane(message):
            at_ns = logged.capture_ns
            pair = pairs.first(at_ns, message) if isinstance(message, TrialMessage) else pairs.second(at_ns, message)
            if pair is not None:
                frame = joined(*pair, logged.capture_ns)
                scorer.frame(frame)
                reel.moments.append(Moment(logged.capture_ns, frame, len(scorer.trials)))
    if not reel.moments:
        raise ConfigurationError(f"{file}: must be a session of ours in which something says where the robot was")
    reel.trials, reel.policies = scorer.trials, [newest[key] for key in sorted(newest)]
    return reel


def _topics(recording: Recording, *schemas: str) -> list[str]:
    return [topic.topic for topic in recording.topics() if topic.schema in schemas]
