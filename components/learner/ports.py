"""Memory, filter, model, sweep: turns percepts and applied commands into a policy table: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.drive_pb2 import Applied
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Snapshot
from schemas.trial_pb2 import Trial


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {
    "percept": Port(Percept, Kind.STATE, hz=8, queue=512),
    "trial": Port(Trial, Kind.EVENT, hz=8, queue=512),
    "applied": Port(Applied, Kind.STATE, hz=8, queue=512),
}
_FRAME = ("percept", "trial", "applied")
OUTPUTS: Mapping[str, Port] = {
    "policy": Port(Policy, Kind.EVENT, on=_FRAME),
    "snapshot": Port(Snapshot, Kind.EVENT, on=_FRAME),
}
