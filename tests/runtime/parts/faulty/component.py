"""Answers each image with a count, and breaks one rule of the contract if told to."""

import time

from runtime.contract import STOP, Event, Output
from schemas.drive_pb2 import BaseCommand
from schemas.session_pb2 import SessionEnd
from tests.runtime.parts.faulty import ports

WORDS = {f"word {number}" for number in range(4096)}


class Faulty:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._fault = params.fault
        self._count = 0

    def handle(self, event: Event) -> tuple[Output, ...]:
        if event.port == STOP:
            return ()
        self._count += 1
        answer = Output("drive", BaseCommand(v_mps=self._number()))
        if self._count == 5:
            if self._fault == "twice":
                return (answer, answer)
            if self._fault == "silent":
                return ()
            if self._fault == "undeclared":
                return (answer, Output("word", SessionEnd()))
        return (answer,)

    def _number(self) -> float:
        if self._fault == "clock":
            return time.monotonic()
        if self._fault == "hash order":
            return float(next(iter(WORDS)).split()[1])
        return float(self._count)

    def save(self) -> bytes:
        return b"" if self._fault == "forgetful" else str(self._count).encode()

    def load(self, state: bytes) -> None:
        self._count = int(state or b"0")
