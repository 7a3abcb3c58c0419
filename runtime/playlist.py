"""What is to be played of a log: chosen topics of a stretch of time, under the names they shall have."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from runtime.clock import LOG_SKEW_NS
from runtime.params import ConfigurationError
from runtime.recorded_launch import specs_of
from runtime.recording import Logged, Recording
from runtime.selection import Selection

_SHELL = ("status", "journal")
_HELD = 16384
"""Messages held in memory to be sorted: four seconds of 4000 a second."""


class Playlist:
    """The messages of one log in the order of their log time; those of one time as they were recorded."""

    def __init__(
        self,
        recording: Recording,
        selection: Selection,
        remap: Mapping[str, str],
        *,
        start_s: float = 0.0,
        duration_s: float | None = None,
        owners: Collection[str] = (),
        known: Collection[str] | None = None,
        by_frame: bool = False,
    ) -> None:
        """Choose.

        Args:
            recording: a session of ours, whole or torn.
            selection: of its topics.
            remap: topic -> key to play it on.
            start_s: from the log's first message.
            duration_s: from there; None = to the end.
            owners: only what these components said on their output ports; empty = everybody, all.
            known: only keys that somebody listens to; None = all.
            by_frame: in the order of capture times instead, for those who answer frame by frame.

        Raises:
            ConfigurationError: no session of ours, nothing left, two topics on one key.
        """
        self._recording = recording
        self._by_frame = by_frame
        launch = recording.launch()
        if not recording.session() or not launch:
            raise ConfigurationError(f"{recording.file}: must be a session recorded by berth")
        self.launch: Mapping[str, Any] = launch
        self._owners = _owners(launch)
        schemas = {row.topic: row.schema for row in recording.topics()}
        if not schemas:
            raise ConfigurationError(f"{recording.file}: must hold messages; there are none that can be read")
        selection.check(schemas, str(recording.file))
        wanted = [topic for topic in schemas if selection.takes(topic) and self._is_of(topic, owners)]
        self._check(remap, schemas, wanted, owners)
        keys = {topic: remap.get(topic, topic) for topic in wanted}
        self._keys = {topic: key for topic, key in keys.items() if known is None or key in known}
        self.topics: dict[str, str] = {key: schemas[topic] for topic, key in self._keys.items()}
        """Key -> full name of its schema."""
        first = next((logged.time_ns for logged in in_order(recording.messages(), LOG_SKEW_NS, _log_ns)), 0)
        self.start_ns = first + round(start_s * 1e9)
        self._end_ns = None if duration_s is None else self.start_ns + round(duration_s * 1e9)
        if next(self.messages(self.start_ns), None) is None:
            raise ConfigurationError(
                f"{recording.file}: must hold messages of these from {start_s:g} s on; it ends before"
            )

    def _is_of(self, topic: str, owners: Collection[str]) -> bool:
        return not owners or (self.owner(topic) in owners and topic.rpartition("/")[2] not in _SHELL)

    def _check(
        self, remap: Mapping[str, str], known: Collection[str], wanted: Collection[str], owners: Collection[str]
    ) -> None:
        file = self._recording.file
        for topic in remap:
            if topic not in known:
                raise ConfigurationError(f"--remap {topic}: must be a topic of {file}: {', '.join(known)}")
        keys = [remap.get(topic, topic) for topic in wanted]
        twice = next((key for key in keys if keys.count(key) > 1), "")
        if twice:
            raise ConfigurationError(f"--remap: must not put two topics on one key; got {twice!r}")
        for owner in owners:
            if not any(self.owner(topic) == owner for topic in wanted):
                names = ", ".join(sorted({self.owner(topic) for topic in known}))
                raise ConfigurationError(f"{file}: must hold messages of {owner}; it holds some of {names}")

    def owner(self, topic: str) -> str:
        """Component that published a topic of the log."""
        return self._owners.get(topic, topic.partition("/")[0])

    @property
    def file(self) -> Path:
        """Of the log."""
        return self._recording.file

    @property
    def owners(self) -> dict[str, str]:
        """Key to play on -> component that published it."""
        return {key: self.owner(topic) for topic, key in self._keys.items()}

    def messages(self, since_ns: int) -> Iterator[Logged]:
        """The chosen messages from a time on, under their new keys."""
        ordered = in_order(self._recording.messages(list(self._keys)), LOG_SKEW_NS, _log_ns)
        chosen = self._chosen(ordered, since_ns)
        return in_order(chosen, LOG_SKEW_NS, _capture_ns) if self._by_frame else chosen

    def _chosen(self, ordered: Iterable[Logged], since_ns: int) -> Iterator[Logged]:
        for logged in ordered:
            if self._end_ns is not None and logged.time_ns > self._end_ns:
                return
            if logged.time_ns >= since_ns:
                yield logged._replace(topic=self._keys[logged.topic])


def _log_ns(logged: Logged) -> int:
    return logged.time_ns


def _capture_ns(logged: Logged) -> int:
    return logged.capture_ns


def in_order(messages: Iterable[Logged], skew_ns: int, time_of: Callable[[Logged], int]) -> Iterator[Logged]:
    """Messages sorted by a time of theirs, those of one time as they came.

    Args:
        messages: nearly sorted: none comes later than the skew after the newest one.
        skew_ns: how much later; so much is held in memory, and never more than a bounded number.
        time_of: the time of a message.
    """
    waiting: list[tuple[int, int, Logged]] = []
    newest_ns = 0
    for number, logged in enumerate(messages):
        time_ns = time_of(logged)
        heapq.heappush(waiting, (time_ns, number, logged))
        newest_ns = max(newest_ns, time_ns)
        while waiting[0][0] < newest_ns - skew_ns or len(waiting) > _HELD:
            yield heapq.heappop(waiting)[2]
    while waiting:
        yield heapq.heappop(waiting)[2]


def _owners(launch: Mapping[str, Any]) -> dict[str, str]:
    """Topic -> component, for the ports of a resolved launch file; of any release, so nothing is taken for granted."""
    return {
        key: str(spec.get("name", ""))
        for spec in specs_of(launch)
        for key in spec["outputs"].values()
        if isinstance(key, str)
    }
