"""`components.grasper` with a fuse."""

from __future__ import annotations

from components.grasper import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.grasper import ports


class Grasper(Fused, component.Grasper):
    """Fails on a message, once it is told to."""

    Params = ports.Params
