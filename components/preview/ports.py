"""Pictures for another host: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from runtime.params import between, positive
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import RecorderAck


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    clock: str = ""
    """Of the session, filled in. In lockstep every picture crosses as it is: time waits for the link."""
    delay_s: float = positive(0.15)
    """A picture acknowledged later than this was too large. Half of `base.max_age_s`: what is left to a command that
    has waited behind it."""
    lost_s: float = positive(1.0)
    """A picture that is not acknowledged by now is lost; then the next one is tried."""
    quality_step: int = between(5, 1, 100)
    """Quality gained by each picture that came in time."""
    least_quality: int = between(10, 1, 100)
    """JPEG quality that is never gone below; then the rate alone falls."""


INPUTS: Mapping[str, Input] = {
    "image": Port(CompressedImage, Kind.IMAGE, hz=8, queue=1),
    "ack": Port(RecorderAck, Kind.EVENT, hz=8),
}
OUTPUTS: Mapping[str, Port] = {"image": Port(CompressedImage, Kind.IMAGE, on=("image",))}
