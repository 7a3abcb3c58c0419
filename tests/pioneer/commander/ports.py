"""Drives ahead, as a pilot would that has no eyes."""

from dataclasses import dataclass

from runtime.contract import Kind, Port, Tick
from schemas.drive_pb2 import Drive


@dataclass(frozen=True)
class Params:
    pass


INPUTS = {"tick": Tick(hz=20)}
OUTPUTS = {"drive": Port(Drive, Kind.COMMAND, on=("tick",))}
