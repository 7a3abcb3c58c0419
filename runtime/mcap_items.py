"""What an MCAP file holds, item by item, believing nothing: lengths are checked before memory is asked for.

A damaged chunk is passed over; where the framing itself is damaged, or the file ends too early, reading ends. Either is
noted in a list of faults, never raised.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from io import BytesIO
from typing import IO, Any, NamedTuple

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Header, Metadata, Schema

MAGIC = b"\x89MCAP0\r\n"
LARGEST_BYTES = 64 * 1024 * 1024
"""Of one record or one unpacked chunk. No record of ours is larger; a hostile length must not ask for memory."""
_FAULTS_KEPT = 100
_FRAME = struct.Struct("<BQ")
_HEAD = struct.Struct("<BQH")
"""A frame and, if it is a message's, its channel: most messages are passed over after that."""
_MESSAGE = struct.Struct("<HIQQ")
_PARSED: dict[int, Any] = {
    int(Opcode.HEADER): Header,
    int(Opcode.SCHEMA): Schema,
    int(Opcode.CHANNEL): Channel,
    int(Opcode.METADATA): Metadata,
    int(Opcode.ATTACHMENT): Attachment,
}
_MESSAGE_CODE, _CHUNK_CODE, _END_CODE = int(Opcode.MESSAGE), int(Opcode.CHUNK), int(Opcode.DATA_END)


class Fault(NamedTuple):
    """What is wrong with a file, and where."""

    offset: int
    """Of the record, bytes from the beginning."""
    words: str


class RawMessage(NamedTuple):
    """One message record."""

    channel: int
    sequence: int
    log_ns: int
    publish_ns: int
    payload: bytes


class End:
    """The data section ends here, as it should."""


Item = Header | Schema | Channel | Metadata | Attachment | RawMessage | End
Wish = Callable[[Channel], bool]


class _DamagedError(Exception):
    """The text says how."""


def items(stream: IO[bytes], faults: list[Fault], wants: Wish | None = None) -> Iterator[Item]:
    """Everything in the file's data section, in order.

    Args:
        stream: of a whole file, at its beginning.
        faults: what is wrong is appended, up to a limit.
        wants: tells whether messages of a channel are wanted; None = of all.
    """
    channels = _Channels(wants)
    try:
        for offset, code, content in _records(stream):
            try:
                yield from _content(code, content, channels)
            except _DamagedError as damage:
                _note(faults, offset, str(damage))
            if code == _END_CODE:
                return
        _note(faults, stream.tell(), "the file ends here, unfinished")
    except _TornError as torn:
        _note(faults, *torn.args)


class _TornError(Exception):
    """Reading can not go on: (offset, words)."""


class _Channels:
    """Which channels are wanted, by id."""

    def __init__(self, wants: Wish | None) -> None:
        self._wants = wants
        self.unwanted: set[int] = set()

    def add(self, channel: Channel) -> None:
        if self._wants is not None:
            (self.unwanted.discard if self._wants(channel) else self.unwanted.add)(channel.id)


def _note(faults: list[Fault], offset: int, words: str) -> None:
    if len(faults) < _FAULTS_KEPT:
        faults.append(Fault(offset, words))


def _records(stream: IO[bytes]) -> Iterator[tuple[int, int, bytes]]:
    """(offset, opcode, content) of each record."""
    offset = stream.seek(len(MAGIC))
    while head := stream.read(_FRAME.size):
        if len(head) < _FRAME.size:
            raise _TornError(offset, f"{len(head)} bytes at the end are no whole record")
        code, length = _FRAME.unpack(head)
        if length > LARGEST_BYTES:
            raise _TornError(offset, f"a record claims {length} bytes; at most {LARGEST_BYTES} are read")
        content = stream.read(length)
        if len(content) < length:
            raise _TornError(offset, f"the last record has {len(content)} of its {length} bytes")
        yield offset, code, content
        offset += _FRAME.size + length


def _content(code: int, content: bytes, channels: _Channels) -> Iterator[Item]:
    if code == _CHUNK_CODE:
        data = _unpacked(_parsed(Chunk, content))
        yield from _chunk_items(data, channels)
    elif code == _MESSAGE_CODE:
        if (message := _message(content, 0, len(content), channels)) is not None:
            yield message
    elif code == _END_CODE:
        yield End()
    elif code in _PARSED:
        yield _described(code, content, channels)


def _described(code: int, content: bytes, channels: _Channels) -> Item:
    item: Item = _parsed(_PARSED[code], content)
    if isinstance(item, Channel):
        channels.add(item)
    return item


def _chunk_items(data: bytes, channels: _Channels) -> Iterator[Item]:
    at, end, unwanted, head = 0, len(data), channels.unwanted, _HEAD
    while at < end:
        if at + _FRAME.size > end:
            raise _DamagedError("a chunk ends within a record")
        code, length, channel = (
            head.unpack_from(data, at) if at + head.size <= end else (*_FRAME.unpack_from(data, at), -1)
        )
        at += _FRAME.size
        if length > end - at:
            raise _DamagedError(f"a record in a chunk claims {length} bytes; {end - at} are left")
        if code != _MESSAGE_CODE:
            if code in _PARSED:
                yield _described(code, data[at : at + length], channels)
        elif channel not in unwanted and (message := _message(data, at, length, channels)) is not None:
            yield message
        at += length


def _message(data: bytes, at: int, length: int, channels: _Channels) -> RawMessage | None:
    """The message at this place, or None if its channel is not wanted."""
    if length < _MESSAGE.size:
        raise _DamagedError(f"a message of {length} bytes has no head")
    channel, sequence, log_ns, publish_ns = _MESSAGE.unpack_from(data, at)
    if channel in channels.unwanted:
        return None
    return RawMessage(channel, sequence, log_ns, publish_ns, data[at + _MESSAGE.size : at + length])


def _parsed(kind: Any, content: bytes) -> Any:
    try:
        return kind.read(ReadDataStream(BytesIO(content)))
    except (McapError, struct.error, ValueError, OverflowError, EOFError):
        raise _DamagedError(f"a {kind.__name__} record of {len(content)} bytes can not be read") from None


def _unpacked(chunk: Chunk) -> bytes:
    size = chunk.uncompressed_size
    if size > LARGEST_BYTES:
        raise _DamagedError(f"a chunk claims {size} bytes unpacked; at most {LARGEST_BYTES} are read")
    try:
        data = _decompressed(chunk.compression, chunk.data, size)
    except (RuntimeError, ValueError, zstandard.ZstdError):
        raise _DamagedError(f"a chunk of {len(chunk.data)} bytes can not be unpacked") from None
    if len(data) != size:
        raise _DamagedError(f"a chunk unpacks to {len(data)} bytes; it claims {size}")
    if chunk.uncompressed_crc not in (0, zlib.crc32(data)):
        raise _DamagedError("a chunk's checksum is wrong")
    return data


def _decompressed(compression: str, data: bytes, size: int) -> bytes:
    """At most one byte more than `size`, whatever the data claims."""
    if compression == "lz4":
        unpacked: bytes = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=size + 1)
        return unpacked
    if compression == "zstd":
        reader = zstandard.ZstdDecompressor(max_window_size=LARGEST_BYTES).stream_reader(BytesIO(data))
        return reader.read(size + 1)
    if compression:
        raise ValueError(compression)
    return data
