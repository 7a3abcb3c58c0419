"""The learner over recorded sessions: the same component, fed from a log instead of the bus."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from google.protobuf.message import DecodeError

from components.learner.component import Learner
from components.learner.ports import Params
from components.pilot.messages import table_of
from docking.policy import PolicyTable
from runtime.contract import STOP, Event, Output
from runtime.handed_over import JOURNAL_ORDER, HandedOver
from runtime.recording import Logged
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Snapshot

SESSION_APART_NS = 3600 * 1_000_000_000
"""Sessions are laid one after another on one time line, so far apart that nothing joins across."""
Inputs = Sequence[tuple[str, Any, int, int]]
"""(input port, message, capture_ns, time_ns), of all sessions, in order."""


@dataclass
class Learned:
    """What a learner made of a log."""

    policy: PolicyTable | None = None
    """The last one it published; None if it learned nothing."""
    snapshots: list[tuple[int, bytes]] = field(default_factory=list)
    """(policy version, SHA-256 of the value table) of each snapshot."""

    def keep(self, outputs: Sequence[Output]) -> None:
        """Take the snapshots among what the learner says."""
        for output in outputs:
            if isinstance(output.message, Snapshot):
                self.snapshots.append((output.message.version, output.message.table_sha256))


def inputs_of(sessions: Sequence[HandedOver], decode: Callable[[str, bytes], Any]) -> Inputs:
    """What the learner is to be fed, decoded once; messages that can not be decoded are left out."""
    found: list[tuple[str, Any, int, int]] = []
    offset_ns = 0
    for session in sessions:
        newest_ns = offset_ns
        for port, logged in session.inputs:
            capture_ns, time_ns = offset_ns + logged.capture_ns, offset_ns + logged.time_ns
            try:
                found.append((port, decode(port, logged.payload), capture_ns, time_ns))
            except DecodeError:
                continue
            newest_ns = max(newest_ns, capture_ns, time_ns)
        offset_ns = newest_ns + SESSION_APART_NS
    return found


class _Unheard(Learner):
    """Nobody listens to each of its policies: making them takes as long as learning."""

    def _policy(self, robot: int) -> Policy:
        del robot
        return Policy()

    def policy(self) -> PolicyTable | None:
        """The newest one; None if nothing was learned."""
        newest = super()._policy(0)
        return table_of(newest) if newest.version > 0 else None


def relearn(params: Params, seed: int, inputs: Inputs) -> Learned:
    """Feed a fresh learner, then stop it.

    Args:
        params: of the learner.
        seed: of the learner.
        inputs: from `inputs_of`.
    """
    learner, learned = _Unheard(params, seed), Learned()
    time_ns = 0
    for port, message, capture_ns, at_ns in inputs:
        time_ns = max(time_ns, at_ns)
        learned.keep(learner.handle(Event(time_ns, port, message, capture_ns)))
    learned.keep(learner.handle(Event(time_ns, STOP, capture_ns=time_ns)))
    learned.policy = learner.policy()
    return learned


def recorded_snapshots(messages: Sequence[Logged]) -> list[tuple[int, bytes]]:
    """Those that the live learner published."""
    found = [Snapshot.FromString(m.payload) for m in messages if m.schema == Snapshot.DESCRIPTOR.full_name]
    return [(snapshot.version, snapshot.table_sha256) for snapshot in found]


class SnapshotCheck(NamedTuple):
    """Whether a log gives again what the live learner had learned from it."""

    same: bool | None
    """None = there is nothing to compare."""
    compared: int
    words: str


def check_snapshots(session: HandedOver, learned: Learned) -> SnapshotCheck:
    """Compare the snapshots of a session with those of a learner that was fed with it alone."""
    live = recorded_snapshots(session.others)
    if not live:
        return SnapshotCheck(None, 0, "no snapshot of the live learner to compare with")
    again = dict(learned.snapshots)
    for number, (version, digest) in enumerate(live, start=1):
        if session.missing and version > max(again, default=0):
            words = f"{number - 1} of {len(live)} snapshots: same hash; the next one's lessons are torn off"
            return SnapshotCheck(number > 1 or None, number - 1, words)
        if again.get(version) != digest:
            words = f"snapshot {number} of {len(live)}: another hash than live, at policy version {version}"
            if session.order == JOURNAL_ORDER:
                return SnapshotCheck(False, number, words)
            return SnapshotCheck(None, number - 1, f"{words}, but the live learner's order is not known")
    return SnapshotCheck(True, len(live), f"snapshot {len(live)} of {len(live)}: same hash")
