"""The ports of `components.tracker`, without its parameters."""

from __future__ import annotations

from benchmarks.ring.relay import NoParams as Params
from components.tracker.ports import INPUTS, OUTPUTS

__all__ = ["INPUTS", "OUTPUTS", "Params"]
