"""Answers each image with a count, and breaks one rule of the contract if told to."""

from dataclasses import dataclass

from runtime.contract import Kind, Port
from runtime.params import one_of
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import SessionEnd


@dataclass(frozen=True)
class Params:
    fault: str = one_of("", "", "clock", "hash order", "twice", "silent", "forgetful", "undeclared")


INPUTS = {"image": Port(CompressedImage, Kind.IMAGE, per_frame=True)}
OUTPUTS = {
    "drive": Port(BaseCommand, Kind.COMMAND, per_frame=True, on=("image",)),
    "word": Port(SessionEnd, Kind.EVENT),
}
