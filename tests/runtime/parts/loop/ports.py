"""Answers a command with a command, at once."""

from dataclasses import dataclass

from runtime.contract import Kind, Port
from schemas.drive_pb2 import BaseCommand


@dataclass(frozen=True)
class Params:
    pass


INPUTS = {"drive": Port(BaseCommand, Kind.COMMAND)}
OUTPUTS = {"drive": Port(BaseCommand, Kind.COMMAND, on=("drive",))}
