"""The ports of `components.head`, without its parameters."""

from __future__ import annotations

from benchmarks.ring.relay import NoParams as Params
from components.head.ports import INPUTS, OUTPUTS

__all__ = ["INPUTS", "OUTPUTS", "Params"]
