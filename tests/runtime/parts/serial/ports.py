"""Doubles each number that its device reads."""

from dataclasses import dataclass

from runtime.contract import DeviceKind, Kind, Port
from runtime.params import positive
from schemas.drive_pb2 import BaseCommand


@dataclass(frozen=True)
class Params:
    pass


@dataclass(frozen=True)
class Line:
    port: str = ""
    baud: int = positive(9600)


DEVICES = {"line": DeviceKind("tests.runtime.parts.serial.line:Line", Line), "played": None}
INPUTS = {"device": Port(BaseCommand, Kind.STATE)}
OUTPUTS = {
    "actuate": Port(BaseCommand, Kind.COMMAND, on=("device",)),
    "device": Port(BaseCommand, Kind.STATE),
}
