"""Stands in for `components.learner`."""

from __future__ import annotations

from benchmarks.ring.relay import Relay
from components.learner.ports import INPUTS, OUTPUTS


class Learner(Relay):
    """Computes nothing."""

    inputs = INPUTS
    outputs = OUTPUTS
