"""The ports of `components.learner`, without its parameters."""

from __future__ import annotations

from benchmarks.ring.relay import NoParams as Params
from components.learner.ports import INPUTS, OUTPUTS

__all__ = ["INPUTS", "OUTPUTS", "Params"]
