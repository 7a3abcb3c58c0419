"""What the robot was told and what it did, in its own time, out of a recording and what a bystander saw."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from components.base.ports import Params as Base
from runtime.contract import TICK
from runtime.journal import entries
from runtime.params import ConfigurationError
from runtime.recording import Logged, Recording

TRUTH, COMMAND, JOURNAL = "simulator/truth", "base/actuate", "base/journal"
_JOIN_NS = round(Base().join_s * 1e9)
_COMMANDERS = {"pilot/drive": "pilot", "grasper/drive": "grasper"}


class Moved(NamedTuple):
    """How the robot truly moved at a moment."""

    at_ns: int
    v_mps: float
    omega_radps: float

    @property
    def still(self) -> bool:
        """Whether it neither drove nor turned."""
        return self.v_mps == 0.0 and self.omega_radps == 0.0


class Told(NamedTuple):
    """A command of base to its device."""

    frame_ns: int
    """Capture time of the frame that it answers; of a stop for another reason, when it was said."""
    said_ns: int
    """When base said it, by base's clock."""
    v_mps: float
    omega_radps: float

    @property
    def still(self) -> bool:
        """Whether it tells the robot to stand."""
        return self.v_mps == 0.0 and self.omega_radps == 0.0


@dataclass(frozen=True)
class Timeline:
    """In order of time."""

    truths: Sequence[Moved]
    commands: Sequence[Told]
    ticks_ns: Sequence[int] = ()
    """When base's own clock called it, as far as is known."""


def timeline(file: Path, truths: Iterable[Moved], commands: Iterable[Told]) -> Timeline:
    """Join a recording, however torn, and what a bystander saw: `said_ns` of his commands is when he heard them."""
    moved = {truth.at_ns: truth for truth in truths}
    heard = {(told.frame_ns, told.v_mps, told.omega_radps): told.said_ns for told in commands}
    said: dict[int, int] = {}
    ticks_ns: list[int] = []
    if is_recording(file):
        rows = list(Recording(file).messages({TRUTH, COMMAND, JOURNAL, *_COMMANDERS}))
        said, ticks_ns = _journal(rows)
        for row in rows:
            message = row.decoded() if row.topic in (TRUTH, COMMAND) else None
            if message is None:
                continue
            if row.topic == TRUTH:
                moved[row.capture_ns] = Moved(row.capture_ns, message.v_mps, message.omega_radps)
            else:
                heard.setdefault((row.capture_ns, message.v_mps, message.omega_radps), row.time_ns)
    told = [_told(key, said.get(key[0]), at_ns) for key, at_ns in heard.items()]
    return Timeline(sorted(moved.values()), sorted(told, key=lambda one: one.said_ns), sorted(ticks_ns))


def _told(key: tuple[int, float, float], answered_ns: int | None, heard_ns: int) -> Told:
    """Its time is when base was handed what it answers; a stop for another reason bears its own."""
    frame_ns, v_mps, omega_radps = key
    if answered_ns is None:
        answered_ns = heard_ns if v_mps or omega_radps else frame_ns
    return Told(frame_ns, max(frame_ns, answered_ns), v_mps, omega_radps)


def is_recording(file: Path) -> bool:
    """Whether there is a file that can be read."""
    try:
        return file.exists() and bool(Recording(file).session())
    except ConfigurationError:
        return False


def _journal(rows: Iterable[Logged]) -> tuple[dict[int, int], list[int]]:
    """(frame -> when base answered it, times of base's ticks), by base's own journal."""
    frames: dict[tuple[str, int, int], int] = {}
    batches = defaultdict(list)
    for row in rows:
        if row.topic in _COMMANDERS:
            frames[_COMMANDERS[row.topic], row.run, row.sequence] = row.capture_ns
        elif row.topic == JOURNAL and (batch := row.decoded()) is not None:
            batches[row.run].append(batch)
    answers = Answers()
    for run in batches.values():
        for entry in entries(sorted(run, key=lambda batch: batch.first)):
            frame_ns = frames.get((entry.port, entry.source_run, entry.source_sequence))
            if frame_ns is not None:
                answers.hear(frame_ns, entry.port, entry.time_ns)
            elif entry.port == TICK:
                answers.tick(entry.time_ns)
    return answers.said_ns, answers.ticks_ns


class Answers:
    """When base answered each frame: when the last commander had, or on the tick after it had waited for him."""

    def __init__(self) -> None:
        self.said_ns: dict[int, int] = {}
        self.ticks_ns: list[int] = []
        self._waiting: dict[int, tuple[str, int]] = {}
        """Frame -> who answered it first, and when."""

    def hear(self, frame_ns: int, commander: str, time_ns: int) -> None:
        """A commander's answer was handed over."""
        if frame_ns in self.said_ns:
            return
        first, _ = self._waiting.setdefault(frame_ns, (commander, time_ns))
        if first != commander:
            self.said_ns[frame_ns] = time_ns
            del self._waiting[frame_ns]

    def tick(self, time_ns: int) -> None:
        """Base's clock has called it."""
        self.ticks_ns.append(time_ns)
        late = [frame for frame, (_, first_ns) in self._waiting.items() if time_ns - first_ns >= _JOIN_NS]
        for frame_ns in late:
            self.said_ns[frame_ns] = time_ns
            del self._waiting[frame_ns]
