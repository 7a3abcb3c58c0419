"""The ports of `components.vision`, without its parameters."""

from __future__ import annotations

from benchmarks.ring.relay import NoParams as Params
from components.vision.ports import INPUTS, OUTPUTS

__all__ = ["INPUTS", "OUTPUTS", "Params"]
