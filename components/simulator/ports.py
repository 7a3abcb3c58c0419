"""The world: plant, camera image, head, gripper, disturbances: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping

from components.simulator.params import SUBSTEPS_HZ, Params
from runtime.contract import Input, Kind, Port, Stall, Tick
from schemas.drive_pb2 import BaseCommand, BaseState
from schemas.head_pb2 import HeadCommand, HeadState
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import LearnerPace, RecorderAck
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth

__all__ = ["INPUTS", "OUTPUTS", "Params"]

INPUTS: Mapping[str, Input] = {
    "drive": Port(BaseCommand, Kind.COMMAND, hz=8, per_frame=True),
    "aim": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True),
    "trial": Port(Trial, Kind.EVENT, hz=8, per_frame=True),
    "ack": Port(RecorderAck, Kind.EVENT, hz=8, optional=True),
    "pace": Port(LearnerPace, Kind.EVENT, hz=8, optional=True),
    "tick": Tick(hz=SUBSTEPS_HZ),
    "stall": Stall(),
}
_STEP = ("drive", "aim", "trial", "ack", "pace", "tick", "stall")
OUTPUTS: Mapping[str, Port] = {
    "image": Port(CompressedImage, Kind.IMAGE, hz=8, per_frame=True, delayed=True, on=_STEP),
    "head": Port(HeadState, Kind.STATE, hz=8, per_frame=True, delayed=True, on=_STEP),
    "base": Port(BaseState, Kind.STATE, hz=8, per_frame=True, delayed=True, on=_STEP),
    "truth": Port(Truth, Kind.STATE, hz=8, per_frame=True, delayed=True, reserved=True, on=_STEP),
}
