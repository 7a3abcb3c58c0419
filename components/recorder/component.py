"""The recorder: a tap, so it has no fold, no journal and no replay."""

from __future__ import annotations

from pathlib import Path

from components.recorder import ports
from components.recorder.gaps import Gaps
from runtime.contract import Output
from runtime.log import LogWriter
from runtime.system import System
from schemas.session_pb2 import Gap, RecorderAck

_FRAME = "foxglove.CompressedImage"


class Recorder:
    """Writes whatever is on the bus, and says aloud what it did not get."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, system: System, started: str) -> None:
        """Open the file.

        Args:
            params: parameters.
            system: the session, for the file's head.
            started: wall-clock time, ISO 8601.
        """
        self._params = params
        self._log = LogWriter(
            Path(params.file),
            system,
            started=started,
            chunk_bytes=params.chunk_bytes,
            compression=params.compression,
        )
        self._gaps = Gaps()
        self._messages = 0
        self._ticks = 0

    def message(
        self, key: str, schema: str, payload: bytes, run: int, sequence: int, capture_ns: int, time_ns: int
    ) -> tuple[Output, ...]:
        """Record one message; answer a camera frame with an acknowledgement, a hole with a gap record."""
        self._log.write(key, schema, payload, run, sequence, capture_ns, time_ns)
        self._messages += 1
        missing = self._gaps.missing(key, run, sequence)
        outputs: tuple[Output, ...] = ()
        if missing:
            outputs = (Output("gap", Gap(key=key, run=run, first_missing=sequence - missing, count=missing)),)
        if schema == _FRAME:
            ack = RecorderAck(messages=self._messages, lost=self._gaps.lost)
            return (*outputs, Output("ack", ack, capture_ns))
        return outputs

    def tick(self, time_ns: int) -> tuple[Output, ...]:  # noqa: ARG002
        """Ten times a second of wall time: flush now and then."""
        self._ticks += 1
        if self._ticks % max(1, round(10 * self._params.flush_s)) == 0:
            self._log.flush()
        return ()

    def close(self) -> tuple[Output, ...]:
        """Finish the file."""
        self._log.close()
        return (Output("ack", RecorderAck(messages=self._messages, lost=self._gaps.lost)),)
