"""`components.pilot` with a fuse."""

from __future__ import annotations

from components.pilot import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.pilot import ports


class Pilot(Fused, component.Pilot):
    """Fails on a message, once it is told to."""

    Params = ports.Params
