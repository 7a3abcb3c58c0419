"""Looks at images, off the control path."""

from dataclasses import dataclass

from runtime.contract import Kind, Port
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import SessionEnd


@dataclass(frozen=True)
class Params:
    pass


INPUTS = {"image": Port(CompressedImage, Kind.IMAGE)}
OUTPUTS = {"word": Port(SessionEnd, Kind.EVENT, on=("image",))}
