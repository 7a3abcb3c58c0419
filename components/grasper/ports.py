"""The pick-up after docking: lower until the beams see the object, close, lift: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from runtime.params import one_of, positive
from schemas.drive_pb2 import BaseState, Drive
from schemas.grasp_pb2 import Grasp
from schemas.trial_pb2 import Trial


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    beams: str = one_of("both", "both", "inner", "outer", "any")
    """Break beams that must be broken: the object is between the fingers."""
    lower_s: float = positive(8.0)
    """Longest time to lower the gripper; the simulated lift takes 1.5 s, a real one may be slow."""
    close_s: float = positive(5.0)
    """Longest time to close the fingers; after that they are taken as closed."""
    lift_s: float = positive(8.0)
    """Longest time to lift; after that nothing is picked up."""
    release_s: float = positive(8.0)
    """Longest time to open the fingers and raise the lift after a miss."""


INPUTS: Mapping[str, Input] = {
    "trial": Port(Trial, Kind.EVENT, hz=8, per_frame=True),
    "base": Port(BaseState, Kind.STATE, hz=8),
}
OUTPUTS: Mapping[str, Port] = {
    "drive": Port(Drive, Kind.COMMAND, hz=8, per_frame=True, on=("trial",)),
    "grasp": Port(Grasp, Kind.EVENT, hz=8, per_frame=True, on=("trial",)),
}
