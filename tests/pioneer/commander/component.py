"""Drives ahead, as a pilot would that has no eyes."""

from runtime.contract import TICK, Event, Output
from schemas.drive_pb2 import Drive
from tests.pioneer.commander import ports


class Commander:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        pass

    def handle(self, event: Event) -> tuple[Output, ...]:
        return (Output("drive", Drive(engaged=True, v_mps=0.1)),) if event.port == TICK else ()
