"""What a process is told when it starts: one line of JSON on its standard input."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from runtime.system import System

READY_TIMEOUT_S = 120.0
"""A first start compiles for a minute on a small machine; a crash is noticed at once, without this."""


@dataclass(frozen=True)
class Kept:
    """A snapshot of a component, kept for its next start."""

    file: str
    """Holds the message."""
    run: int
    """Run id of the component then."""
    sequence: int
    """Of the message among that run's snapshots."""


@dataclass(frozen=True)
class Assignment:
    """One component of a system, to be run as a process."""

    system: System
    name: str
    """Of the component."""
    peers: tuple[str, ...]
    """Components that the start waits for, itself included, on all hosts."""
    endpoint: str
    """Of the host's router."""
    origin_ns: int
    """Monotonic time at which session time is 0; shared by the processes of a host."""
    started: str
    """Wall-clock time of the session's start, ISO 8601."""
    restarts: int = 0
    """How often this component was started again."""
    ready_timeout_s: float = READY_TIMEOUT_S
    snapshot: Kept | None = None
    """Where it shall go on; None = it starts cold."""

    def to_json(self) -> str:
        """One line of text from which `from_json` makes the same assignment."""
        table = {**asdict(self), "system": self.system.to_json()}
        return json.dumps(table)

    @staticmethod
    def from_json(text: str) -> Assignment:
        """Inverse of `to_json`."""
        table = json.loads(text)
        table["system"] = System.from_json(table["system"])
        table["peers"] = tuple(table["peers"])
        table["snapshot"] = Kept(**table["snapshot"]) if table["snapshot"] else None
        return Assignment(**table)
