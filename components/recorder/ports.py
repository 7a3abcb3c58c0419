"""Recorder: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from runtime.params import between, one_of, positive
from schemas.session_pb2 import Gap, RecorderAck

TAP = True


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    file: str = ""
    """Path of the MCAP file; empty = `berth run` chooses a name in recordings/."""
    flush_s: float = between(0.5, 0.01, 1.0)
    """Wall time between flushes: what a `kill -9` may cost."""
    chunk_bytes: int = positive(262144)
    """A chunk's end stalls the writer; 256 KiB keeps that below 2 ms (measured)."""
    compression: str = one_of("lz4", "lz4", "zstd", "none")
    """JPEG does not compress; lz4 costs least."""
    leave_out: tuple[str, ...] = ()
    """Keys that are not asked for: images that would fill a link to another host, while their preview crosses it."""


INPUTS: Mapping[str, Input] = {}
OUTPUTS: Mapping[str, Port] = {
    "ack": Port(RecorderAck, Kind.EVENT, hz=8),
    "gap": Port(Gap, Kind.EVENT),
}
