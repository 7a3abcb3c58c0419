"""Stands in for `components.grasper`."""

from __future__ import annotations

from benchmarks.ring.relay import Relay
from components.grasper.ports import INPUTS, OUTPUTS


class Grasper(Relay):
    """Computes nothing."""

    inputs = INPUTS
    outputs = OUTPUTS
