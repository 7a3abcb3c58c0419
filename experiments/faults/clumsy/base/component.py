"""`components.base` with a fuse."""

from __future__ import annotations

from components.base import component
from experiments.faults.clumsy.base import ports
from experiments.faults.clumsy.fuse import Fused


class Base(Fused, component.Base):
    """Fails on a message, once it is told to."""

    Params = ports.Params
