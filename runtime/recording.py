"""Reads a session's MCAP file: whole, torn, or somebody else's."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, NamedTuple

from google.protobuf.message import DecodeError
from mcap.exceptions import McapError
from mcap.reader import NonSeekingReader, SeekingReader
from mcap.records import Attachment, Channel, Metadata, Schema
from mcap.stream_reader import StreamReader

from runtime.log import LAUNCH, SESSION
from runtime.messages import message_class
from runtime.params import ConfigurationError

_RECORD_LIMIT = 64 * 1024 * 1024
"""No record of ours is larger; a hostile length must not ask for memory."""


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


@dataclass(frozen=True)
class Recording:
    """A session's file.

    Raises:
        ConfigurationError: the file can not be read or is not MCAP.
    """

    file: Path

    def __post_init__(self) -> None:
        """Refuse what is not MCAP at once."""
        with self._open() as stream:
            if stream.read(8) != b"\x89MCAP0\r\n":
                raise ConfigurationError(f"{self.file}: must be an MCAP file")

    def _open(self) -> IO[bytes]:
        try:
            return self.file.open("rb")
        except OSError as error:
            raise ConfigurationError(f"{self.file}: can not be read: {error.strerror}") from None

    def session(self) -> dict[str, str]:
        """Metadata of the session; empty in a file that is not ours."""
        for record in self._first_records(Metadata):
            if record.name == SESSION:
                return dict(record.metadata)
        return {}

    def launch(self) -> dict[str, Any]:
        """The resolved launch file; empty in a file that is not ours."""
        for record in self._first_records(Attachment):
            if record.name == LAUNCH:
                table: dict[str, Any] = json.loads(record.data)
                return table
        return {}

    def _first_records(self, kind: type[Any]) -> Iterator[Any]:
        """Records of one kind among the first few, which is where a session describes itself."""
        with self._open() as stream:
            try:
                for index, record in enumerate(StreamReader(stream, record_size_limit=_RECORD_LIMIT).records):
                    if isinstance(record, kind):
                        yield record
                    if index > 16:
                        return
            except (McapError, ValueError, EOFError):
                return

    def messages(self, topics: Collection[str] | None = None) -> Iterator[Logged]:
        """Messages in the order of the file; a torn tail ends it quietly (`whole` tells).

        Args:
            topics: keys below the realm to read; None = all.
        """
        for schema, channel, record in self._records(topics):
            yield Logged(
                channel.topic,
                schema.name if schema is not None else "",
                record.data,
                int(channel.metadata.get("run", "0"), 16),
                record.sequence,
                record.publish_time,
                record.log_time,
            )

    def _records(self, topics: Collection[str] | None) -> Iterator[tuple[Schema | None, Channel, Any]]:
        with self._open() as stream:
            reader = SeekingReader(stream) if self.whole() else NonSeekingReader(stream, False, (), _RECORD_LIMIT)
            try:
                yield from reader.iter_messages(topics=topics, log_time_order=False)
            except (McapError, EOFError):
                return

    def whole(self) -> bool:
        """Whether the file was finished: it ends in MCAP's magic."""
        with self._open() as stream:
            stream.seek(0, 2)
            if stream.tell() < 16:
                return False
            stream.seek(-8, 2)
            return stream.read(8) == b"\x89MCAP0\r\n"

    def topics(self) -> list[Topic]:
        """What is in the file, per key and run, in order of appearance."""
        counts: dict[tuple[str, int], list[int]] = {}
        names: dict[tuple[str, int], str] = {}
        for schema, channel, record in self._records(None):
            key = (channel.topic, int(channel.metadata.get("run", "0"), 16))
            names.setdefault(key, schema.name if schema is not None else "")
            row = counts.setdefault(key, [0, 0, 0, record.sequence])
            row[0] += 1
            row[1] += len(record.data)
            row[2] += max(0, record.sequence - row[3])
            row[3] = record.sequence + 1
        return [Topic(key[0], names[key], key[1], row[0], row[1], row[2]) for key, row in counts.items()]
