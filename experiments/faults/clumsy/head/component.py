"""`components.head` with a fuse."""

from __future__ import annotations

from components.head import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.head import ports


class Head(Fused, component.Head):
    """Fails on a message, once it is told to."""

    Params = ports.Params
