"""The named failures of a session, from what the pilot said alone: a real robot has no ground truth."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

from schemas.trial_pb2 import Trial


class Failed(NamedTuple):
    """One trial that failed."""

    phase: str
    number: int
    name: str
    """Of the failure, e.g. `object lost`; its rule is in `components.pilot.diagnosis`."""
    at_s: float
    """Session time of what the name rests on."""
    ended_s: float
    outcome: str
    side: str
    """Which of two compared policies drove; else empty."""

    def table(self) -> dict[str, Any]:
        """As a JSON object."""
        return {**self._asdict(), "at_s": round(self.at_s, 3), "ended_s": round(self.ended_s, 3)}


class Endings:
    """Folds trial messages into ended trials; nonsense changes nothing."""

    def __init__(self) -> None:
        self.failed: list[Failed] = []
        self._ended: dict[int, int] = {}

    def take(self, message: Trial, capture_ns: int) -> bool:
        """Take one message of the pilot; returns whether a trial ended with it."""
        ended = message.ended > self._ended.get(message.phase, 0) and message.phase != Trial.FINISHED
        self._ended[message.phase] = message.ended
        if ended and message.failure in _NAMES and message.failure != Trial.NO_FAILURE:
            self.failed.append(
                Failed(
                    Trial.Phase.Name(message.phase) if message.phase in _PHASES else "",
                    message.number,
                    _NAMES[message.failure],
                    message.failure_ns * 1e-9,
                    capture_ns * 1e-9,
                    Trial.Outcome.Name(message.outcome) if message.outcome in _OUTCOMES else "",
                    message.side if message.side in {"a", "b"} else "",
                )
            )
        return ended


def counted(failed: Sequence[Failed]) -> dict[str, int]:
    """How many failures have each name, the most frequent first."""
    return dict(Counter(failure.name for failure in failed).most_common())


_NAMES = {number: name.lower().replace("_", " ") for name, number in Trial.Failure.items()}
_PHASES, _OUTCOMES = (frozenset(names.values()) for names in (Trial.Phase, Trial.Outcome))
