"""Object centroid and table-edge slope from one image: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping

from components.vision.params import Params
from runtime.contract import Input, Kind, Port
from schemas.image_pb2 import CompressedImage
from schemas.view_pb2 import View

__all__ = ["INPUTS", "OUTPUTS", "Params"]

INPUTS: Mapping[str, Input] = {"image": Port(CompressedImage, Kind.IMAGE, hz=8, queue=1, per_frame=True)}
OUTPUTS: Mapping[str, Port] = {"view": Port(View, Kind.STATE, hz=8, per_frame=True, on=("image",))}
