"""The journal of a run: what its shell handed to `handle`, in order, in batches. Pure."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from schemas.session_pb2 import Journal

LOADED = "loaded"
"""Port of an entry that is no event: the run went on from a snapshot, whose run and sequence stand there."""
BATCH_EVENTS = 256
BATCH_NS = 100_000_000


class Entry(NamedTuple):
    """One event of a run."""

    number: int
    """Of the event in its run, from 0."""
    port: str
    source_run: int
    """0 for events that the shell itself made."""
    source_sequence: int
    time_ns: int


class JournalWriter:
    """Collects events and gives them out as `Journal` messages."""

    def __init__(self, events: int = BATCH_EVENTS, batch_ns: int = BATCH_NS) -> None:
        """Start a run.

        Args:
            events: a batch holds at most this many.
            batch_ns: and is given out at most this long after its first one.
        """
        self._limit = events
        self._batch_ns = batch_ns
        self._ports: dict[str, int] = {}
        self._first = 0
        self._opened_ns = 0
        self._last_ns = 0
        self._columns: tuple[list[int], list[int], list[int], list[int]] = ([], [], [], [])

    def add(self, port: str, source_run: int, source_sequence: int, time_ns: int, monotonic_ns: int) -> None:
        """Note one event at the moment it is handed over."""
        ports, runs, sequences, deltas = self._columns
        if not ports:
            self._opened_ns = monotonic_ns
            self._last_ns = 0
        ports.append(self._ports.setdefault(port, len(self._ports)))
        runs.append(source_run)
        sequences.append(source_sequence)
        deltas.append(time_ns - self._last_ns)
        self._last_ns = time_ns

    def due_ns(self) -> int | None:
        """Monotonic time at which the open batch must be given out; None if it is empty."""
        return self._opened_ns + self._batch_ns if self._columns[0] else None

    def is_due(self, monotonic_ns: int) -> bool:
        """Whether the open batch is full or old."""
        count = len(self._columns[0])
        return count >= self._limit or (count > 0 and monotonic_ns >= self._opened_ns + self._batch_ns)

    def take(self) -> Journal | None:
        """The open batch as a message, and start the next; None if it is empty."""
        ports, runs, sequences, deltas = self._columns
        if not ports:
            return None
        batch = Journal(
            first=self._first,
            ports=list(self._ports),
            port=ports,
            source_run=runs,
            source_sequence=sequences,
            time_delta_ns=deltas,
        )
        self._first += len(ports)
        self._columns = ([], [], [], [])
        return batch


def entries(batches: Iterable[Journal]) -> Iterator[Entry]:
    """The events of a run, in order, from its batches; the caller looks for holes in `number`.

    Raises:
        ValueError: a batch whose columns differ in length or name an unknown port.
    """
    for batch in batches:
        columns = (batch.port, batch.source_run, batch.source_sequence, batch.time_delta_ns)
        if len({len(column) for column in columns}) != 1 or any(port >= len(batch.ports) for port in batch.port):
            raise ValueError(f"the journal batch that begins at event {batch.first} is damaged")
        time_ns = 0
        for offset, (port, run, sequence, delta_ns) in enumerate(zip(*columns, strict=True)):
            time_ns += delta_ns
            yield Entry(batch.first + offset, batch.ports[port], run, sequence, time_ns)
