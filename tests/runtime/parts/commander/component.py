"""Wants the base for itself once a trial has ended."""

from runtime.contract import Event, Output
from schemas.drive_pb2 import Drive
from tests.runtime.parts.commander import ports

SPEED_MPS, TURN_RATE_RADPS = 0.1, 0.5
"""A circle of 0.2 m."""


class Commander:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._engaged = False

    def handle(self, event: Event) -> tuple[Output, ...]:
        if event.port == "trial":
            self._engaged = event.message.ended > 0
        if event.port != "base":
            return ()
        return (Output("drive", Drive(engaged=self._engaged, v_mps=SPEED_MPS, omega_radps=TURN_RATE_RADPS)),)
