"""Answers each image with a command, unless told to fail."""

from runtime.contract import GONE, STOP, Event, Output
from schemas.drive_pb2 import BaseCommand
from tests.runtime.parts.echo import ports


class Echo:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._params = params
        self._images = -1

    def handle(self, event: Event) -> tuple[Output, ...]:
        if event.port == GONE:
            return (Output("drive", BaseCommand(v_mps=-1.0)),)
        if event.port == STOP:
            return (Output("drive", BaseCommand(v_mps=-2.0)),)
        self._images += 1
        if self._images == self._params.crash_at:
            raise RuntimeError("told to crash")
        if self._images == self._params.silent_at:
            return ()
        return (Output("drive", BaseCommand(v_mps=event.capture_ns / 1e9)),)
