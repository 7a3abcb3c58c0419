"""`components.learner` with a fuse."""

from __future__ import annotations

from components.learner import component
from experiments.faults.clumsy.fuse import Fused
from experiments.faults.clumsy.learner import ports


class Learner(Fused, component.Learner):
    """Fails on a message, once it is told to."""

    Params = ports.Params
