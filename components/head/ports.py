"""Pan-tilt unit driver: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.head_pb2 import HeadCommand, HeadState


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {
    "aim": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True),
    "device": Port(HeadState, Kind.STATE, hz=8, per_frame=True),
}
OUTPUTS: Mapping[str, Port] = {
    "state": Port(HeadState, Kind.STATE, hz=8, per_frame=True, on=("device",)),
    "actuate": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True, on=("aim",)),
}
