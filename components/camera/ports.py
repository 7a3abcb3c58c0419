"""Frames for the eyes: from a device, or from a session that is played in its place: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.image_pb2 import CompressedImage


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""


INPUTS: Mapping[str, Input] = {"device": Port(CompressedImage, Kind.IMAGE, hz=8, queue=1, optional=True)}
OUTPUTS: Mapping[str, Port] = {"image": Port(CompressedImage, Kind.IMAGE, hz=8, per_frame=True, on=("device",))}
