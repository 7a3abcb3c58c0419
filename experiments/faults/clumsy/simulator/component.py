"""`components.simulator` with a fuse."""

from __future__ import annotations

from components.simulator import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.simulator import ports


class Simulator(Fused, component.Simulator):
    """Fails on a message, once it is told to."""

    Params = ports.Params
