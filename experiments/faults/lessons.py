"""What a learner that was started again had forgotten."""

from __future__ import annotations

from pathlib import Path

from runtime.journal import LOADED, entries
from runtime.recording import Logged, Recording

_SAVED_NS = 1_000_000_000
"""A trial that ended this shortly before the death may be on its way into a snapshot."""
_TRIAL, _SNAPSHOT, _JOURNAL = "pilot/trial", "learner/snapshot", "learner/journal"


def trials_lost(file: Path, died_ns: int) -> int:
    """Trials that had ended before a learner died at `died_ns` and were not in the snapshot that it went on from.

    Raises:
        StopIteration: the recording does not show that it was started again.
    """
    rows = list(Recording(file).messages({_TRIAL, _SNAPSHOT, _JOURNAL}))
    trials = [row for row in rows if row.topic == _TRIAL]
    taken_ns = _taken_ns(rows, died_ns)
    before = _ended(trials, died_ns - _SAVED_NS)
    return max(0, before - (0 if taken_ns is None else _ended(trials, taken_ns)))


def _ended(trials: list[Logged], at_ns: int) -> int:
    """Training trials that had ended by then."""
    newest = max((row for row in trials if row.capture_ns <= at_ns), key=lambda row: row.capture_ns, default=None)
    return 0 if newest is None else int(newest.decoded().ended)


def _taken_ns(rows: list[Logged], died_ns: int) -> int | None:
    """Capture time of the snapshot that the next run went on from; None = it started cold."""
    first = next(row for row in rows if row.topic == _JOURNAL and row.time_ns > died_ns and _begins(row))
    entry = next(iter(entries([first.decoded()])))
    if entry.port != LOADED:
        return None
    name = (entry.source_run, entry.source_sequence)
    return next((r.capture_ns for r in rows if r.topic == _SNAPSHOT and (r.run, r.sequence) == name), None)


def _begins(row: Logged) -> bool:
    return bool(row.decoded().first == 0)
