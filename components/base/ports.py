"""The robot base: drive, odometry, gripper, safety: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Peers, Port, Tick
from schemas.drive_pb2 import Applied, BaseCommand, BaseState, Drive


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {
    "teleop": Port(Drive, Kind.COMMAND, optional=True),
    "grasper": Port(Drive, Kind.COMMAND, hz=8, optional=True, per_frame=True),
    "pilot": Port(Drive, Kind.COMMAND, hz=8, per_frame=True),
    "device": Port(BaseState, Kind.STATE, hz=8, per_frame=True),
    "tick": Tick(hz=50),
    "gone": Peers(),
}
"""One port per commander, highest priority first."""
_COMMANDS = ("teleop", "grasper", "pilot", "tick", "gone")
OUTPUTS: Mapping[str, Port] = {
    "actuate": Port(BaseCommand, Kind.COMMAND, hz=8, per_frame=True, on=_COMMANDS),
    "applied": Port(Applied, Kind.STATE, hz=8, per_frame=True, on=_COMMANDS),
    "state": Port(BaseState, Kind.STATE, hz=8, per_frame=True, on=("device",)),
}
