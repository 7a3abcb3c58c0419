"""Answers each image with a command, unless told to fail."""

from dataclasses import dataclass

from runtime.contract import Kind, Peers, Port
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage


@dataclass(frozen=True)
class Params:
    crash_at: int = -1
    """Raises at this image of its run."""
    silent_at: int = -1
    """Does not answer this image of its run."""


INPUTS = {"image": Port(CompressedImage, Kind.IMAGE, queue=1, per_frame=True), "gone": Peers()}
OUTPUTS = {"drive": Port(BaseCommand, Kind.COMMAND, per_frame=True, on=("image",))}
