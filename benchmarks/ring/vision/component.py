"""Stands in for `components.vision`."""

from __future__ import annotations

from benchmarks.ring.relay import Relay
from components.vision.ports import INPUTS, OUTPUTS


class Vision(Relay):
    """Computes nothing."""

    inputs = INPUTS
    outputs = OUTPUTS
