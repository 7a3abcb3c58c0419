"""What a learner that was started again had forgotten."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path

from runtime.journal import LOADED, entries
from runtime.recording import Logged, Recording

TRIAL, POLICY, SNAPSHOT = "pilot/trial", "learner/policy", "learner/snapshot"
_JOURNAL = "learner/journal"
_SAVED_NS = 1_000_000_000
"""A trial that ended this shortly before the death may be on its way into a snapshot."""


def trials_lost(file: Path, died_ns: int) -> int:
    """Trials that a learner, dead at `died_ns`, had learned from to their end and did not know any more afterwards.

    Raises:
        StopIteration: the recording does not show that it was started again.
    """
    rows = list(Recording(file).messages({TRIAL, POLICY, SNAPSHOT, _JOURNAL}))
    begins = [row for row in rows if row.topic == _JOURNAL and row.decoded().first == 0]
    again = next(row for row in begins if row.time_ns > died_ns)
    born_ns = max((row.time_ns for row in begins if row.time_ns <= died_ns), default=0)
    ended = sorted((row.capture_ns, int(row.decoded().ended)) for row in rows if row.topic == TRIAL)
    learned_ns = [row.capture_ns for row in rows if row.topic == POLICY and born_ns <= row.capture_ns <= died_ns]
    return forgotten(ended, learned_ns, max(born_ns, _taken_ns(rows, again)), died_ns)


def forgotten(ended: Sequence[tuple[int, int]], learned_ns: Iterable[int], known_until_ns: int, died_ns: int) -> int:
    """Trials that ended after something was learned that is not known any more.

    Args:
        ended: (capture time, trials that had ended by then), in order.
        learned_ns: when the learner that died said a policy, that is, had learned something.
        known_until_ns: the time of the snapshot that it went on from, or of its first start.
        died_ns: when it died.
    """
    first_ns = min((at_ns for at_ns in learned_ns if at_ns > known_until_ns), default=died_ns)
    ends_ns = [at_ns for (_, before), (at_ns, now) in pairwise(ended) if now > before]
    return sum(first_ns < at_ns <= died_ns - _SAVED_NS for at_ns in ends_ns)


def _taken_ns(rows: Iterable[Logged], first: Logged) -> int:
    """Capture time of the snapshot that the run with this first batch went on from; 0 = it started cold."""
    entry = next(iter(entries([first.decoded()])))
    name = (entry.source_run, entry.source_sequence) if entry.port == LOADED else None
    return next((row.capture_ns for row in rows if row.topic == SNAPSHOT and (row.run, row.sequence) == name), 0)
