"""A world that shows an image once its last one was answered."""

from dataclasses import dataclass

from runtime.contract import Kind, Port, Stall, Tick
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import RecorderAck, SessionEnd


@dataclass(frozen=True)
class Params:
    frames: int = 50
    """The session ends after so many; 0 = never."""
    payload_bytes: int = 1000
    window: int = 0
    """So many frames may be shown that the recorder has not acknowledged; 0 = any number, recorded or not."""
    clock: str = "lockstep"


INPUTS = {
    "drive": Port(BaseCommand, Kind.COMMAND, per_frame=True),
    "ack": Port(RecorderAck, Kind.EVENT, optional=True),
    "tick": Tick(hz=8),
    "stall": Stall(),
}
OUTPUTS = {
    "image": Port(CompressedImage, Kind.IMAGE, per_frame=True, delayed=True, on=("drive", "ack", "tick", "stall")),
    "end": Port(SessionEnd, Kind.EVENT, delayed=True, on=("drive", "ack")),
}
