"""How old a frame is when each component is handed what was made of it, from the journals of a session in real time."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from runtime.recorded_launch import specs_of
from runtime.recording import Logged

_LONGEST_S = 60.0
"""Older than this is nonsense, or a message from before a pause."""
Ages = NDArray[np.float64]


class Hop(NamedTuple):
    """One input of one component."""

    component: str
    port: str
    topic: str
    schema: str
    ages_ms: Ages
    """From the frame's exposure to `handle`, of each message handed over."""

    def percentiles_ms(self) -> tuple[float, float, float]:
        """Half, 95 and 99 % of the messages were at most so old."""
        half, most, nearly_all = np.percentile(self.ages_ms, (50, 95, 99))
        return float(half), float(most), float(nearly_all)


class Latency:
    """Folds a session's messages into hops. In lockstep there are none: time waits for every answer."""

    def __init__(self, launch: Mapping[str, Any]) -> None:
        """Begin, for the system of a resolved launch file, of whatever release."""
        self._specs = specs_of(launch)
        self.is_lockstep = launch.get("clock") == "lockstep"
        self._host = next((str(s.get("host")) for s in self._specs if self._is_camera(s)), "")
        self._captures: dict[tuple[str, int], tuple[array[int], array[int]]] = {}
        self._schemas: dict[str, str] = {}
        self._journals: dict[str, list[Any]] = {}

    @staticmethod
    def _is_camera(spec: Mapping[str, Any]) -> bool:
        return "camera/image" in spec["outputs"].values()

    def take(self, logged: Logged) -> None:
        """Take one message."""
        if self.is_lockstep:
            return
        if logged.schema == "berth.Journal":
            journal = logged.decoded()
            if journal is not None:
                self._journals.setdefault(logged.topic, []).append(journal)
            return
        key = (logged.topic, logged.run)
        columns = self._captures.get(key)
        if columns is None:
            columns = self._captures[key] = (array("q"), array("q"))
            self._schemas[logged.topic] = logged.schema
        columns[0].append(logged.sequence & 0xFFFFFFFF)
        columns[1].append(min(logged.capture_ns, 2**62))

    def hops(self) -> list[Hop]:
        """Of the components on the camera's host, the youngest frames first; other hosts have other clocks."""
        found = []
        for spec in self._specs:
            batches = self._journals.get(f"{spec.get('name')}/journal", [])
            if batches and str(spec.get("host")) == self._host:
                found += self._hops_of(spec, batches)
        return sorted(found, key=lambda hop: float(np.median(hop.ages_ms)))

    def _hops_of(self, spec: Mapping[str, Any], batches: list[Any]) -> list[Hop]:
        ages: dict[str, list[Ages]] = {}
        for batch in batches:
            columns = [np.array(column, dtype=np.uint64) for column in (batch.port, batch.source_run)]
            sequence = np.array(batch.source_sequence, dtype=np.uint64).astype(np.int64) & 0xFFFFFFFF
            times_ns = np.cumsum(np.array(batch.time_delta_ns, dtype=np.int64))
            if len({len(sequence), len(times_ns), *map(len, columns)}) != 1:
                continue
            for index, port in enumerate(batch.ports):
                topic = str(spec["inputs"].get(port, ""))
                for run in np.unique(columns[1][columns[0] == index]):
                    here = (columns[0] == index) & (columns[1] == run)
                    age = self._ages_ms(topic, int(run), sequence[here], times_ns[here])
                    if age.size:
                        ages.setdefault(port, []).append(age)
        name, topics = str(spec.get("name")), {port: str(spec["inputs"][port]) for port in ages}
        return [
            Hop(name, port, topics[port], self._schemas[topics[port]], np.concatenate(rows))
            for port, rows in ages.items()
        ]

    def _ages_ms(self, topic: str, run: int, sequence: NDArray[np.int64], times_ns: NDArray[np.int64]) -> Ages:
        known = self._captures.get((topic, run))
        if known is None:
            return np.empty(0)
        sequences, captures = (np.frombuffer(column, dtype=np.int64) for column in known)
        place = np.minimum(np.searchsorted(sequences, sequence), len(sequences) - 1)
        age_ms = (times_ns - captures[place])[sequences[place] == sequence] * 1e-6
        return np.asarray(age_ms[(age_ms >= 0.0) & (age_ms <= 1e3 * _LONGEST_S)])
