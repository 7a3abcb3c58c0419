"""Drives in a circle of 0.2 m, small enough for any room."""

from __future__ import annotations

from benchmarks.circling import ports
from runtime.contract import Event, Output
from schemas.drive_pb2 import Drive

SPEED_MPS, TURN_RATE_RADPS = 0.1, 0.5


class Circling:
    """Answers each state of the base."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del params, seed  # there is nothing to choose

    def handle(self, event: Event) -> tuple[Output, ...]:
        """See the class."""
        if event.port != "base":
            return ()
        return (Output("drive", Drive(engaged=True, v_mps=SPEED_MPS, omega_radps=TURN_RATE_RADPS)),)
