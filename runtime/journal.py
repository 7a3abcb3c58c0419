"""The journal: what a shell handed to `handle`, in order, so that a replay can hand over the same."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from schemas.session_pb2 import Journal

LIMIT = 256
"""Entries of one batch."""


class Entry(NamedTuple):
    """One event: which message, and when it was handed over."""

    number: int
    """From 0 per run id."""
    port: str
    """Input port; `gone:NAME` for the end of a peer."""
    source_run: int
    source_sequence: int
    time_ns: int


class JournalWriter:
    """Collects entries into batches."""

    def __init__(self) -> None:
        self._first = 0
        self._ports: dict[str, int] = {}
        self._rows: list[tuple[int, int, int, int]] = []

    def __len__(self) -> int:
        """Entries that no batch has taken yet."""
        return len(self._rows)

    def add(self, port: str, source_run: int, source_sequence: int, time_ns: int) -> None:
        """Note one event, right before it is handed over."""
        self._rows.append((self._ports.setdefault(port, len(self._ports)), source_run, source_sequence, time_ns))

    def take(self) -> Journal:
        """Everything noted since the last batch, as one message that can be read by itself."""
        batch = Journal(first=self._first, ports=list(self._ports))
        before_ns = 0
        for port, run, sequence, time_ns in self._rows:
            batch.port.append(port)
            batch.source_run.append(run)
            batch.source_sequence.append(sequence)
            batch.time_delta_ns.append(time_ns - before_ns)
            before_ns = time_ns
        self._first += len(self._rows)
        self._rows.clear()
        return batch


def entries(batch: Journal) -> Iterator[Entry]:
    """The entries of a batch.

    Raises:
        ValueError: columns of different length, or an unknown port.
    """
    columns = (batch.port, batch.source_run, batch.source_sequence, batch.time_delta_ns)
    if len({len(column) for column in columns}) != 1 or any(port >= len(batch.ports) for port in batch.port):
        raise ValueError("a journal's columns must have one length and name known ports")
    time_ns = 0
    for index, (port, run, sequence, delta_ns) in enumerate(zip(*columns, strict=True)):
        time_ns += delta_ns
        yield Entry(batch.first + index, batch.ports[port], run, sequence, time_ns)
