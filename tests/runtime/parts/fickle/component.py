"""Answers each image with a sum, and lets something into it that no journal knows of, if told to."""

import random
import time

from runtime.contract import GONE, STOP, Event, Output
from schemas.drive_pb2 import BaseCommand
from tests.runtime.parts.fickle import ports


class Fickle:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS
    answered = 0
    """Of all instances: hidden state that outlives a run."""

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._params = params
        self._sum = 0.0

    def handle(self, event: Event) -> tuple[Output, ...]:
        if event.port == STOP:
            return ()
        if event.port == GONE:
            return (Output("drive", BaseCommand(v_mps=float(len(event.message)))),)
        if self._params.fault == "raises" and event.capture_ns > 2_000_000_000:
            raise RuntimeError("told to raise")
        self._sum += self._params.gain * event.capture_ns / 1e9
        Fickle.answered += 1
        return (Output("drive", BaseCommand(v_mps=self._sum, omega_radps=self._foreign())),)

    def _foreign(self) -> float:
        foreign = {"clock": time.monotonic, "random": random.random, "hidden": lambda: float(Fickle.answered)}
        return foreign.get(self._params.fault, lambda: 0.0)()
