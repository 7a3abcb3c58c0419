"""Sums what it sees, and now and then publishes all that it knows."""

from dataclasses import dataclass

from runtime.contract import Kind, Port
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import Snapshot


@dataclass(frozen=True)
class Params:
    every: int = 8
    """Images between snapshots."""


INPUTS = {"image": Port(CompressedImage, Kind.IMAGE, per_frame=True)}
OUTPUTS = {
    "drive": Port(BaseCommand, Kind.COMMAND, per_frame=True, on=("image",)),
    "snapshot": Port(Snapshot, Kind.EVENT, on=("image",)),
}
