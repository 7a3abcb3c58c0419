"""Doubles each number that its device reads."""

from runtime.contract import STOP, Event, Output
from schemas.drive_pb2 import BaseCommand
from tests.runtime.parts.serial import ports


class Serial:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        pass

    def handle(self, event: Event) -> tuple[Output, ...]:
        if event.port == STOP:
            return (Output("actuate", BaseCommand(v_mps=-1.0)),)
        return (Output("actuate", BaseCommand(v_mps=2.0 * event.message.v_mps)),)
