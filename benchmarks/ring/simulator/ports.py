"""The ports of `components.simulator`, an end, and how much to send."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from components.simulator.ports import INPUTS
from components.simulator.ports import OUTPUTS as _OUTPUTS
from runtime.contract import Kind, Port
from runtime.params import positive
from schemas.session_pb2 import SessionEnd

__all__ = ["INPUTS", "OUTPUTS", "Params"]


@dataclass(frozen=True)
class Params:
    """Parameters."""

    frames: int = positive(1000)
    """Frames until the end."""
    image_bytes: int = positive(10_000)
    """As large as a 320x240 JPEG."""


OUTPUTS: Mapping[str, Port] = {**_OUTPUTS, "end": Port(SessionEnd, Kind.EVENT, delayed=True, on=("drive",))}
