"""State of each process, and what was lost on the way."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from schemas.session_pb2 import Status
from viewer.shown import Number, Remark, Shown, Word

_SILENT = 3
"""Words that every other process has said since this one's last: then it is called silent."""
_HELD = 64
"""Processes; more are of no system of ours."""


@dataclass
class _Process:
    run: int
    status: Status
    starts: int = 1
    others: Counter[str] = field(default_factory=Counter)
    """Words of every other process since this one's last."""
    word: str = ""


class Processes:
    """Folds the words that every process says of itself once a second."""

    def __init__(self) -> None:
        """Nobody has said anything."""
        self._processes: dict[str, _Process] = {}
        self._next: dict[tuple[str, int], int] = {}
        self.missing = 0
        """Messages that were said and not heard here."""

    def heard(self, topic: str, run: int, sequence: int, capture_ns: int) -> list[Shown]:
        """Any message: a hole in its numbers is a loss."""
        hole = max(0, sequence - self._next.get((topic, run), sequence))
        self._next[topic, run] = sequence + 1
        self.missing += hole
        return [Shown("lost/messages", capture_ns, Number(float(self.missing)))] if hole else []

    def status(self, message: Status, run: int, time_ns: int) -> list[Shown]:
        """A process's word."""
        name = message.component[:40]
        process = self._processes.get(name)
        if process is None:
            if len(self._processes) >= _HELD:
                return []
            process = self._processes[name] = _Process(run, message)
        shown = self._noted(name, process, message, time_ns)
        if run != process.run:
            process.starts += 1
            shown.append(Shown("log/processes", time_ns, Remark(f"{name} was started again", is_bad=True)))
        process.run, process.status = run, message
        for other, each in self._processes.items():
            if other == name:
                each.others.clear()
            else:
                each.others[name] += 1
        return shown + self._lanes(time_ns)

    def _noted(self, name: str, process: _Process, message: Status, time_ns: int) -> list[Shown]:
        if not message.note or (message.note == process.status.note and process.status is not message):
            return []
        return [Shown("log/processes", time_ns, Remark(f"{name}: {message.note[:200]}", is_bad=True))]

    def _lanes(self, time_ns: int) -> list[Shown]:
        """Who has changed between running and silent."""
        shown = []
        for name in self._processes:
            word = self.state(name)
            if self._processes[name].word != word:
                self._processes[name].word = word
                shown.append(Shown(f"processes/{name}", time_ns, Word(word)))
        return shown

    def state(self, name: str) -> str:
        """Running, or silent: all others have gone on talking."""
        since = [self._processes[name].others[other] for other in self._processes if other != name]
        return "silent" if since and min(since) >= _SILENT else "running"

    def table(self) -> str:
        """As Markdown."""
        heads = ("process", "state", "starts", "handled", "lost", "skipped", "refused", "note")
        head = f"| {' | '.join(heads)} |\n|---|---|---:|---:|---:|---:|---:|---|\n"
        return head + "".join(self._row(name) for name in sorted(self._processes))

    def _row(self, name: str) -> str:
        process, status = self._processes[name], self._processes[name].status
        counts = (process.starts, status.handled, status.lost, status.skipped, status.malformed)
        note = status.note[:80].replace("|", "/").replace("\n", " ")
        return f"| {name} | {self.state(name)} | {' | '.join(map(str, counts))} | {note} |\n"
