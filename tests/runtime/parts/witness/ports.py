"""A tap that writes down what it hears, one JSON list a line."""

from dataclasses import dataclass

from runtime.contract import Kind, Port
from schemas.session_pb2 import RecorderAck

TAP = True


@dataclass(frozen=True)
class Params:
    file: str = ""


INPUTS: dict = {}
OUTPUTS = {"ack": Port(RecorderAck, Kind.EVENT)}
