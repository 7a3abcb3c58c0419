"""`components.tracker` with a fuse."""

from __future__ import annotations

from components.tracker import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.tracker import ports


class Tracker(Fused, component.Tracker):
    """Fails on a message, once it is told to."""

    Params = ports.Params
