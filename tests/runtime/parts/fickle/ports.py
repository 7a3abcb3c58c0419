"""Answers each image with a sum, and lets something into it that no journal knows of, if told to."""

from dataclasses import dataclass

from runtime.contract import Kind, Peers, Port
from runtime.params import one_of
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage


@dataclass(frozen=True)
class Params:
    fault: str = one_of("", "", "clock", "random", "hidden", "raises")
    gain: float = 1.0


INPUTS = {"image": Port(CompressedImage, Kind.IMAGE, queue=1, per_frame=True), "gone": Peers()}
OUTPUTS = {"drive": Port(BaseCommand, Kind.COMMAND, per_frame=True, on=("image",))}
