"""Reads a session's MCAP file: whole, torn, or somebody else's."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, NamedTuple

from google.protobuf.message import DecodeError
from mcap.records import Attachment, Channel, Metadata, Schema

from runtime.log import FORMAT, LAUNCH, SESSION
from runtime.mcap_items import MAGIC, Fault, Item, RawMessage, items
from runtime.messages import message_class
from runtime.params import ConfigurationError

_HEAD_ITEMS = 16
"""A session describes itself before its first message, in fewer items than this."""


class Logged(NamedTuple):
    """One message of a session."""

    topic: str
    schema: str
    payload: bytes
    run: int
    sequence: int
    capture_ns: int
    time_ns: int

    def decoded(self) -> Any:
        """The message, or None if its schema is not one of ours or its bytes are damaged."""
        kind = message_class(self.schema)
        try:
            return kind.FromString(self.payload) if kind is not None else None
        except DecodeError:
            return None


@dataclass(frozen=True)
class Topic:
    """What a session holds of one key and run."""

    topic: str
    schema: str
    run: int
    count: int
    bytes: int
    lost: int
    gaps: int = 0
    """Holes in the sequence; `lost` messages are missing in them."""
    hz: float = 0.0
    """Mean rate in session time; 0 if there is but one message."""


@dataclass(frozen=True)
class Recording:
    """A session's file.

    Raises:
        ConfigurationError: the file can not be read, is not MCAP, or was written by a newer release.
    """

    file: Path

    def __post_init__(self) -> None:
        """Refuse at once what can not be read rightly."""
        with self._open() as stream:
            magic = stream.read(len(MAGIC))
        if magic[:5] == MAGIC[:5] and magic[6:] == MAGIC[6:] and magic != MAGIC:
            raise ConfigurationError(f"{self.file}: must be MCAP version 0; got version {magic[5:6]!r}")
        if magic != MAGIC:
            raise ConfigurationError(f"{self.file}: must be an MCAP file")
        version = self.session().get("format", "1")  # the first sessions did not say it
        if version not in map(str, range(1, FORMAT + 1)):
            raise ConfigurationError(
                f"{self.file}: session format must be one that this release reads, up to {FORMAT}; got {version[:40]!r}"
            )

    def _open(self) -> IO[bytes]:
        try:
            return self.file.open("rb")
        except OSError as error:
            raise ConfigurationError(f"{self.file}: can not be read: {error.strerror}") from None

    def session(self) -> dict[str, str]:
        """Metadata of the session; empty in a file that is not ours."""
        for item in self._head():
            if isinstance(item, Metadata) and item.name == SESSION:
                return dict(item.metadata)
        return {}

    def launch(self) -> dict[str, Any]:
        """The resolved launch file; empty in a file that is not ours."""
        for item in self._head():
            if isinstance(item, Attachment) and item.name == LAUNCH:
                try:
                    table = json.loads(item.data)
                except (ValueError, RecursionError):
                    return {}
                return table if isinstance(table, dict) else {}
        return {}

    def _head(self) -> Iterator[Item]:
        for index, item in enumerate(self.items([], lambda _: False)):
            if index > _HEAD_ITEMS or isinstance(item, Schema):
                return
            yield item

    def items(self, faults: list[Fault], wants: Any = None) -> Iterator[Item]:
        """Everything in the file; see `runtime.mcap_items.items`."""
        with self._open() as stream:
            yield from items(stream, faults, wants)

    def messages(self, topics: Collection[str] | None = None, faults: list[Fault] | None = None) -> Iterator[Logged]:
        """Messages in the order of the file; a torn tail ends it quietly (`whole` tells).

        Args:
            topics: keys below the realm to read; None = all.
            faults: what is wrong with the file is appended.
        """
        wanted = None if topics is None else frozenset(topics)
        schemas: dict[int, str] = {}
        channels: dict[int, tuple[str, str, int]] = {}
        wants = None if wanted is None else lambda channel: channel.topic in wanted
        for item in self.items([] if faults is None else faults, wants):
            if isinstance(item, RawMessage):
                known = channels.get(item.channel)
                if known is not None:
                    topic, schema, run = known
                    yield Logged(topic, schema, item.payload, run, item.sequence, item.publish_ns, item.log_ns)
            elif isinstance(item, Schema):
                schemas[item.id] = item.name
            elif isinstance(item, Channel):
                channels[item.id] = (item.topic, schemas.get(item.schema_id, ""), run_of(item))

    def whole(self) -> bool:
        """Whether the file was finished: it ends in MCAP's magic."""
        with self._open() as stream:
            size = stream.seek(0, 2)
            if size < 2 * len(MAGIC):
                return False
            stream.seek(-len(MAGIC), 2)
            return stream.read(len(MAGIC)) == MAGIC

    def topics(self) -> list[Topic]:
        """What is in the file, per key and run, in order of appearance."""
        tallies = Tallies()
        for logged in self.messages():
            tallies.add(logged)
        return tallies.topics()


class Tallies:
    """Counts the messages of each key and run."""

    def __init__(self) -> None:
        """Nothing is counted."""
        self._tallies: dict[tuple[str, int], _Tally] = {}

    def add(self, logged: Logged) -> None:
        """Count one message."""
        key = (logged.topic, logged.run)
        tally = self._tallies.get(key)
        if tally is None:
            tally = self._tallies[key] = _Tally(logged)
        tally.add(logged)

    def topics(self) -> list[Topic]:
        """What was counted, in order of appearance."""
        return [tally.topic() for tally in self._tallies.values()]


class _Tally:
    """Counts the messages of one key and run."""

    __slots__ = ("_bytes", "_count", "_first", "_gaps", "_last", "_lost", "_next")

    def __init__(self, first: Logged) -> None:
        self._first, self._last = first, first
        self._count = self._bytes = self._lost = self._gaps = 0
        self._next = first.sequence

    def add(self, logged: Logged) -> None:
        self._count += 1
        self._bytes += len(logged.payload)
        if logged.sequence > self._next:
            self._lost += logged.sequence - self._next
            self._gaps += 1
        self._next = logged.sequence + 1
        self._last = logged

    def topic(self) -> Topic:
        first = self._first
        span_ns = self._last.time_ns - first.time_ns
        hz = (self._count - 1) * 1e9 / span_ns if span_ns > 0 else 0.0
        return Topic(first.topic, first.schema, first.run, self._count, self._bytes, self._lost, self._gaps, hz)


def run_of(channel: Channel) -> int:
    """Run id of a channel's publisher; 0 in a file that is not ours."""
    try:
        return int(channel.metadata.get("run", "0"), 16)
    except ValueError:
        return 0
