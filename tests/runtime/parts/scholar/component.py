"""Sums what it sees, and now and then publishes all that it knows."""

import struct

from runtime.contract import STOP, Event, Output
from schemas.drive_pb2 import BaseCommand
from schemas.session_pb2 import Snapshot
from tests.runtime.parts.scholar import ports


class Scholar:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._params = params
        self._images, self._sum = 0, 0.0

    def handle(self, event: Event) -> tuple[Output, ...]:
        if event.port == STOP:
            return ()
        self._images += 1
        self._sum += event.capture_ns / 1e9
        drive = Output("drive", BaseCommand(v_mps=self._sum))
        if self._images % self._params.every:
            return (drive,)
        return (drive, Output("snapshot", Snapshot(version=self._images, state=self.save())))

    def save(self) -> bytes:
        return struct.pack("<Qd", self._images, self._sum)

    def load(self, state: bytes) -> None:
        if len(state) != 16:
            raise ValueError(f"state must have 16 bytes; got {len(state)}")
        self._images, self._sum = struct.unpack("<Qd", state)
