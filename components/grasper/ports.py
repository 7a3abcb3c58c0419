"""The pick-up after docking: lower until the beams see the object, close, lift: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.drive_pb2 import BaseState, Drive
from schemas.grasp_pb2 import Grasp
from schemas.trial_pb2 import Trial


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {
    "trial": Port(Trial, Kind.EVENT, hz=8, per_frame=True),
    "base": Port(BaseState, Kind.STATE, hz=8),
}
OUTPUTS: Mapping[str, Port] = {
    "drive": Port(Drive, Kind.COMMAND, hz=8, per_frame=True, on=("trial",)),
    "grasp": Port(Grasp, Kind.EVENT, hz=8, per_frame=True, on=("trial",)),
}
