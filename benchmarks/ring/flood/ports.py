"""A source of images and small messages: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port, Tick
from runtime.params import positive
from schemas.image_pb2 import CompressedImage
from schemas.percept_pb2 import Percept
from schemas.session_pb2 import SessionEnd

IMAGE_HZ, SMALL_HZ = 30, 500


@dataclass(frozen=True)
class Params:
    """Parameters."""

    image_bytes: int = positive(40_000)
    """As large as a 640x480 JPEG of quality 80."""
    duration_s: float = positive(60.0)
    """Session time of the end."""


INPUTS: Mapping[str, Input] = {"tick": Tick(hz=SMALL_HZ)}
OUTPUTS: Mapping[str, Port] = {
    "image": Port(CompressedImage, Kind.IMAGE, hz=IMAGE_HZ),
    "small": Port(Percept, Kind.STATE, hz=SMALL_HZ),
    "end": Port(SessionEnd, Kind.EVENT),
}
