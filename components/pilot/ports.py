"""Policies, teacher, trials, reverse: turns percepts into drive commands: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.drive_pb2 import BaseState, Drive
from schemas.grasp_pb2 import Grasp
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import SessionEnd
from schemas.trial_pb2 import Trial


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {
    "percept": Port(Percept, Kind.STATE, hz=8, per_frame=True),
    "policy": Port(Policy, Kind.EVENT, optional=True),
    "base": Port(BaseState, Kind.STATE, hz=8),
    "grasp": Port(Grasp, Kind.EVENT, hz=8, optional=True),
}
OUTPUTS: Mapping[str, Port] = {
    "drive": Port(Drive, Kind.COMMAND, hz=8, per_frame=True, on=("percept",)),
    "trial": Port(Trial, Kind.EVENT, hz=8, per_frame=True, on=("percept",)),
    "end": Port(SessionEnd, Kind.EVENT, on=("percept",)),
}
