"""Keeps the object in the image centre; publishes the percept: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.drive_pb2 import Applied
from schemas.head_pb2 import HeadCommand, HeadState
from schemas.percept_pb2 import Percept
from schemas.view_pb2 import View


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {
    "view": Port(View, Kind.STATE, hz=8, per_frame=True),
    "head": Port(HeadState, Kind.STATE, hz=8, per_frame=True),
    "applied": Port(Applied, Kind.STATE, hz=8),
}
OUTPUTS: Mapping[str, Port] = {
    "percept": Port(Percept, Kind.STATE, hz=8, per_frame=True, on=("view", "head")),
    "aim": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True, on=("view", "head")),
}
