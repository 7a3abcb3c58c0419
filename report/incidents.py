"""What went wrong in the machinery of a session, and when: who died, was late, refused, lost or stopped the robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from runtime.contract import STALL
from runtime.journal import LOADED
from runtime.recorded_launch import specs_of
from runtime.recording import Logged
from schemas.session_pb2 import Status

_APART_S = 5.0
"""The same thing again within this time is the same incident."""
_MOST = 2000
"""Incidents kept; a file may be anybody's."""
_DIED = "died, and was started again"
_OTHERS = frozenset({"", "none", "stop"})
"""What base says when nobody wants the robot, or at the end of the session: nothing went wrong."""
_STOPS = {
    "stale": "let commands go for their age and stopped",
    "gone": "stopped: a process on the way from the camera to the wheels was gone",
    "guard": "was stopped by its device's guard",
    "bumper": "stopped: the bumper closed",
    "rear-bumper": "stopped on its way back: the rear bumper closed",
    "rear": "stopped on its way back: something was behind it",
    "reverse": "stopped on its way back: it had driven as far as it may",
    "fence": "stopped on its way back: too far from where it began",
    "dead-man": "stopped: nobody held the dead-man key",
}
_COUNTED = (
    ("lost", "missed", "of its inputs' messages were lost on their way"),
    ("skipped", "late", "inputs were replaced by newer ones before it came to them"),
    ("malformed", "refused", "messages were refused"),
)
"""Counter of `Status`, kind, words."""


@dataclass
class Incident:
    """One of them; what recurs soon is one."""

    kind: str
    """died, resumed, late, missed, refused, lost, stopped, stalled, unusable."""
    who: str
    words: str
    from_s: float
    to_s: float
    count: int = 1

    def table(self) -> dict[str, Any]:
        """As a JSON object."""
        return {**vars(self), "from_s": round(self.from_s, 3), "to_s": round(self.to_s, 3)}


class Incidents:
    """Folds a session's messages into incidents."""

    def __init__(self, commanders: frozenset[str] = frozenset()) -> None:
        """Begin; `commanders` are base's input ports: who drives is no incident."""
        self.found: list[Incident] = []
        self._fine = _OTHERS | commanders
        self._open: dict[tuple[str, str, str], Incident] = {}
        self._runs: dict[str, int] = {}
        self._heard_s: dict[str, float] = {}
        self._status: dict[tuple[str, int], Status] = {}
        self._takers: Mapping[str, Callable[[Logged, Any], None]] = {
            "berth.Status": self._take_status,
            "berth.Hold": self._take_hold,
            "berth.Gap": self._take_gap,
            "berth.Applied": self._take_applied,
            "berth.BaseState": self._take_base,
            "berth.View": self._take_view,
            "berth.Journal": self._take_journal,
        }

    def wants(self, schema: str) -> bool:
        """Whether messages of this kind are to be taken."""
        return schema in self._takers

    def take(self, logged: Logged, message: Any) -> None:
        """Take one message of a kind that is wanted."""
        self._takers[logged.schema](logged, message)

    def _take_status(self, logged: Logged, status: Status) -> None:
        who, at_s = logged.topic.partition("/")[0], logged.time_ns * 1e-9
        if self._runs.setdefault(who, logged.run) != logged.run:
            self._note_return(who, at_s)
            self._runs[who] = logged.run
        self._heard_s[who] = at_s
        before = self._status.get((who, logged.run), Status())
        for name, kind, words in _COUNTED:
            more = getattr(status, name) - getattr(before, name)
            if more > 0:
                reason = f": {status.note[:200]}" if kind == "refused" and status.note else ""
                self._note(kind, who, words + reason, at_s, more)
        if status.note and status.note != before.note and status.malformed == before.malformed:
            self._note("stalled", who, status.note[:200], at_s)
        self._status[who, logged.run] = status

    def _take_hold(self, logged: Logged, hold: Any) -> None:
        if hold.active and hold.component:
            self._note("died", hold.component[:60], _DIED, logged.time_ns * 1e-9)

    def _take_gap(self, logged: Logged, gap: Any) -> None:
        self._note("lost", gap.key[:60], "messages did not reach the recorder", logged.time_ns * 1e-9, gap.count)

    def _take_applied(self, logged: Logged, applied: Any) -> None:
        if applied.commander not in self._fine:
            words = _STOPS.get(applied.commander, f"said {applied.commander[:40]!r}")
            self._note("stopped", logged.topic.partition("/")[0], words, logged.capture_ns * 1e-9)

    def _take_base(self, logged: Logged, state: Any) -> None:
        if state.fault:
            words = f"its device lets nothing move: {state.fault[:200]}"
            self._note("stopped", logged.topic.partition("/")[0], words, logged.capture_ns * 1e-9)

    def _take_view(self, logged: Logged, view: Any) -> None:
        if view.fault:
            who = logged.topic.partition("/")[0]
            self._note("unusable", who, f"images: {view.fault[:200]}", logged.capture_ns * 1e-9)

    def _take_journal(self, logged: Logged, journal: Any) -> None:
        who = logged.topic.partition("/")[0]
        for port, words in (
            (STALL, "went on without an answer that did not come"),
            (LOADED, "went on from a snapshot"),
        ):
            if port in journal.ports and list(journal.ports).index(port) in journal.port:
                self._note("stalled" if port == STALL else "resumed", who, words, logged.time_ns * 1e-9)

    def _note_return(self, who: str, at_s: float) -> None:
        """Somebody speaks in another run: the supervisor has told of its death, or nobody has."""
        known = self._open.get(("died", who, _DIED))
        if known is not None and known.from_s >= self._heard_s[who]:
            known.to_s = at_s
        else:
            self._note("died", who, f"was last heard at {self._heard_s[who]:.1f} s, and was started again", at_s)

    def _note(self, kind: str, who: str, words: str, at_s: float, count: int = 1) -> None:
        key = (kind, who, words)
        known = self._open.get(key)
        if known is not None and at_s - known.to_s <= _APART_S:
            known.to_s, known.count = max(known.to_s, at_s), known.count + count
        elif len(self.found) < _MOST:
            self._open[key] = Incident(kind, who, words, at_s, at_s, count)
            self.found.append(self._open[key])


def commanders_of(launch: Mapping[str, Any]) -> frozenset[str]:
    """Every input port of every component: base says by one of its own who drives."""
    return frozenset(str(port) for spec in specs_of(launch) for port in spec["inputs"])
