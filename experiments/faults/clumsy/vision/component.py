"""`components.vision` with a fuse."""

from __future__ import annotations

from components.vision import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.vision import ports


class Vision(Fused, component.Vision):
    """Fails on a message, once it is told to."""

    Params = ports.Params
