"""A session is one MCAP file that explains itself: this writes it, `runtime.recording` reads it.

Topic = key below the realm. One channel per topic and run id, whose MCAP `sequence` is the publisher's and whose
`publish_time` is the capture time. `log_time` is session time at reception; in lockstep on the bus, where a recorder
may be two seconds late, it is the capture time (`runtime.clock.LogTimes`), so a file is not quite sorted by it. Nobody
has to keep the order of the file: the journal alone says in which order a component was handed its messages.
"""

from __future__ import annotations

import json
import os
import shutil
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from mcap.writer import CompressionType, Writer

from runtime.chunk_index import kept_in_a_file
from runtime.contract import ComponentError
from runtime.fingerprint import fingerprint
from runtime.messages import descriptor_set
from runtime.params import ConfigurationError
from runtime.system import System

LIBRARY = "berth"
SESSION = "berth.session"
"""Name of the metadata record that describes the session."""
FORMAT = 1
"""Of a session's file; the metadata says it. Raised when a reader of an earlier release would misread the file."""
LAUNCH = "launch.json"
"""Name of the attachment that holds the resolved launch file."""
_COMPRESSION = {"lz4": CompressionType.LZ4, "zstd": CompressionType.ZSTD, "none": CompressionType.NONE}


class LogWriter:
    """Writes one session. Whatever fails later, what was flushed before stays readable.

    Raises:
        ConfigurationError: the file exists already or can not be made.
        ComponentError: from any method, once: the file can not be written any more. What is written after that is
            dropped.
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
        self._file = file
        self._stream = _created(file)
        self._newest_ns = 0
        """Session time of the newest message."""
        self._flushed_ns = 0
        self._writer = Writer(self._stream, chunk_size=chunk_bytes, compression=_COMPRESSION[compression])
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, int], int] = {}
        try:
            self._index = kept_in_a_file(self._writer, file.parent)
            self._describe(system, started)
        except OSError as error:
            raise self._failed(error) from None

    def _describe(self, system: System, started: str) -> None:
        self._writer.start(profile="", library=LIBRARY)
        self._writer.add_metadata(
            SESSION,
            {
                "format": str(FORMAT),
                "realm": system.realm,
                "clock": system.clock,
                "seed": str(system.seed),
                "started": started,
                "fingerprint": json.dumps(fingerprint(), sort_keys=True),
            },
        )
        self._writer.add_attachment(0, 0, LAUNCH, "application/json", system.text.encode())
        self._stream.flush()

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
            time_ns: session time, see above; within a channel never decreasing.
        """
        if self._stream.closed:
            return
        try:
            channel = self._channels.get((topic, run)) or self._register(topic, schema, run)
            self._writer.add_message(channel, max(time_ns, 0), payload, max(capture_ns, 0), sequence & 0xFFFFFFFF)
        except OSError as error:
            raise self._failed(error) from None
        self._newest_ns = max(self._newest_ns, time_ns)

    def _register(self, topic: str, schema: str, run: int) -> int:
        if schema not in self._schemas:
            self._schemas[schema] = self._writer.register_schema(schema, "protobuf", descriptor_set(schema))
        channel = self._writer.register_channel(topic, "protobuf", self._schemas[schema], {"run": f"{run:016x}"})
        self._channels[topic, run] = channel
        return channel

    def flush(self) -> None:
        """End the chunk and hand everything to the operating system."""
        if self._stream.closed:
            return
        try:
            self._writer.flush()
            if os.fstat(self._stream.fileno()).st_nlink == 0:
                raise self._vanished()
        except OSError as error:
            raise self._failed(error) from None
        self._flushed_ns = self._newest_ns

    def close(self) -> None:
        """Finish the file. It may be called twice."""
        if self._stream.closed:
            return
        self.flush()
        try:
            self._writer.finish()
            self._stream.close()
            self._index.close()
        except OSError as error:
            raise self._failed(error) from None

    def _failed(self, error: OSError) -> ComponentError:
        with suppress(OSError):  # what is left in the buffer has no room either
            self._stream.close()
        return ComponentError(
            f"{self._file}: can not be written any more: {error.strerror}; it is kept up to "
            f"{self._flushed_ns / 1e9:.3f} s, see `berth recover`"
        )

    def _vanished(self) -> ComponentError:
        """Somebody has removed the file: its content is still there as long as we hold it open."""
        self._stream.seek(0)
        with _created(self._file) as rescued:
            shutil.copyfileobj(self._stream, rescued)
        self._stream.close()
        return ComponentError(f"{self._file}: was removed while it was recorded; what it held was written there again")


def _created(file: Path) -> IO[Any]:
    try:
        with suppress(FileExistsError):  # no folder: told when the file is opened
            file.parent.mkdir(parents=True, exist_ok=True)
        return file.open("x+b")
    except FileExistsError:
        raise ConfigurationError(f"{file}: must not exist yet; a recording is never overwritten") from None
    except OSError as error:
        raise ConfigurationError(f"{file}: can not be made: {error.strerror}") from None
