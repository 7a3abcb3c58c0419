"""A session is one MCAP file that explains itself: this writes it, `runtime.recording` reads it.

Topic = key below the realm. One channel per topic and run id, whose MCAP `sequence` is the publisher's and whose
`publish_time` is the capture time; `log_time` is session time at reception.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import IO, Any

from mcap.writer import CompressionType, Writer

from runtime.fingerprint import fingerprint
from runtime.launch import System
from runtime.messages import descriptor_set
from runtime.params import ConfigurationError

LIBRARY = "berth"
SESSION = "berth.session"
"""Name of the metadata record that describes the session."""
LAUNCH = "launch.json"
"""Name of the attachment that holds the resolved launch file."""
_COMPRESSION = {"lz4": CompressionType.LZ4, "zstd": CompressionType.ZSTD, "none": CompressionType.NONE}


class LogWriter:
    """Writes one session.

    Raises:
        ConfigurationError: the file exists already or can not be made.
    """

    def __init__(
        self, file: Path, system: System, *, started: str, chunk_bytes: int = 262144, compression: str = "lz4"
    ) -> None:
        """Open the file and write what is known before the first message.

        Args:
            file: path to make; an existing file is never overwritten.
            system: the session's resolved launch file.
            started: wall-clock time at the start, ISO 8601: the only wall-clock value in the file.
            chunk_bytes: size of an MCAP chunk.
            compression: lz4, zstd or none.
        """
        self._stream = _created(file)
        self._writer = Writer(self._stream, chunk_size=chunk_bytes, compression=_COMPRESSION[compression])
        self._writer.start(profile="", library=LIBRARY)
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, int], int] = {}
        self._writer.add_metadata(
            SESSION,
            {
                "realm": system.realm,
                "clock": system.clock,
                "seed": str(system.seed),
                "started": started,
                "fingerprint": json.dumps(fingerprint(), sort_keys=True),
            },
        )
        self._writer.add_attachment(0, 0, LAUNCH, "application/json", system.text.encode())

    def write(
        self, topic: str, schema: str, payload: bytes, run: int, sequence: int, capture_ns: int, time_ns: int
    ) -> None:
        """Append one message.

        Args:
            topic: key below the realm.
            schema: full name of the message, e.g. `berth.Percept`.
            payload: its bytes.
            run: run id of the publisher.
            sequence: of the publisher on this key.
            capture_ns: capture time.
            time_ns: session time at reception.
        """
        channel = self._channels.get((topic, run))
        if channel is None:
            channel = self._register(topic, schema, run)
        self._writer.add_message(channel, max(time_ns, 0), payload, max(capture_ns, 0), sequence & 0xFFFFFFFF)

    def _register(self, topic: str, schema: str, run: int) -> int:
        if schema not in self._schemas:
            self._schemas[schema] = self._writer.register_schema(schema, "protobuf", descriptor_set(schema))
        channel = self._writer.register_channel(topic, "protobuf", self._schemas[schema], {"run": f"{run:016x}"})
        self._channels[topic, run] = channel
        return channel

    def flush(self) -> None:
        """End the chunk and hand everything to the operating system."""
        self._writer.flush()
        self._stream.flush()

    def close(self) -> None:
        """Finish the file. It may be called twice."""
        if not self._stream.closed:
            self._writer.finish()
            self._stream.close()


def _created(file: Path) -> IO[Any]:
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        return file.open("xb")
    except FileExistsError:
        raise ConfigurationError(f"{file}: must not exist yet; a recording is never overwritten") from None
    except OSError as error:
        raise ConfigurationError(f"{file}: can not be made: {error.strerror}") from None
