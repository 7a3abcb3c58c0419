"""Mends a torn or damaged recording: what is readable goes into a new, finished file with an index."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mcap.records import Attachment, Channel, Header, Metadata, Schema
from mcap.writer import CompressionType, Writer

from runtime.mcap_items import Fault, Item, RawMessage
from runtime.params import ConfigurationError
from runtime.recording import Recording

_CHUNK_BYTES = 262144


@dataclass
class Mended:
    """What was found."""

    messages: int = 0
    until_ns: int = 0
    """Session time of the newest message."""
    faults: list[Fault] = field(default_factory=list)
    """What could not be read, and where."""
    lost: dict[str, int] = field(default_factory=dict)
    """Topic -> messages missing in its sequences."""

    @property
    def is_lossy(self) -> bool:
        """Whether anything is missing."""
        return bool(self.faults or self.lost)


def mend(recording: Recording, output: Path) -> Mended:
    """Write a finished file from whatever can be read. Reads the recording once, in bounded memory.

    Args:
        recording: torn, damaged or whole; never changed.
        output: path to make; an existing file is never overwritten.

    Raises:
        ConfigurationError: the output exists or can not be written, or nothing at all can be read.
    """
    mended = Mended()
    try:
        with output.open("xb") as stream:
            _Copy(Writer(stream, chunk_size=_CHUNK_BYTES, compression=CompressionType.LZ4), mended).run(recording)
    except FileExistsError:
        raise ConfigurationError(f"{output}: must not exist yet; a recording is never overwritten") from None
    except OSError as error:
        raise ConfigurationError(f"{output}: can not be written: {error.strerror}") from None
    if not mended.messages and mended.faults:
        output.unlink()
        raise ConfigurationError(f"{recording.file}: must hold at least one readable message; {mended.faults[0].words}")
    return mended


class _Copy:
    def __init__(self, writer: Writer, mended: Mended) -> None:
        self._writer = writer
        self._mended = mended
        self._started = False
        self._schemas: dict[int, int] = {}
        self._channels: dict[int, tuple[int, str]] = {}
        self._next: dict[int, int] = {}

    def run(self, recording: Recording) -> None:
        for item in recording.items(self._mended.faults):
            if isinstance(item, Header):
                self._start(item.profile, item.library)
            else:
                self._start("", "berth")
                self._add(item)
        self._start("", "berth")
        self._writer.finish()

    def _start(self, profile: str, library: str) -> None:
        if not self._started:
            self._writer.start(profile=profile, library=library)
            self._started = True

    def _add(self, item: Item) -> None:
        writer = self._writer
        if isinstance(item, RawMessage):
            self._message(item)
        elif isinstance(item, Metadata):
            writer.add_metadata(item.name, item.metadata)
        elif isinstance(item, Attachment):
            writer.add_attachment(item.create_time, item.log_time, item.name, item.media_type, item.data)
        elif isinstance(item, Schema):
            if item.id not in self._schemas:
                self._schemas[item.id] = writer.register_schema(item.name, item.encoding, item.data)
        elif isinstance(item, Channel) and item.id not in self._channels:
            self._channels[item.id] = (self._registered(item, item.metadata), item.topic)

    def _registered(self, channel: Channel, metadata: Mapping[str, str]) -> int:
        schema = self._schemas.get(channel.schema_id, 0)
        return self._writer.register_channel(channel.topic, channel.message_encoding, schema, dict(metadata))

    def _message(self, message: RawMessage) -> None:
        known = self._channels.get(message.channel)
        if known is None:
            self._lose(f"channel {message.channel}, which is not described", 1)
            return
        channel, topic = known
        self._lose(topic, message.sequence - self._next.get(channel, message.sequence))
        self._next[channel] = message.sequence + 1
        self._mended.messages += 1
        self._mended.until_ns = max(self._mended.until_ns, message.log_ns)
        self._writer.add_message(channel, message.log_ns, message.payload, message.publish_ns, message.sequence)

    def _lose(self, topic: str, count: int) -> None:
        if count > 0:
            self._mended.lost[topic] = self._mended.lost.get(topic, 0) + count
