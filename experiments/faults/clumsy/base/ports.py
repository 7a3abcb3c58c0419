"""The ports of `components.base`, and a fuse."""

from __future__ import annotations

from dataclasses import dataclass

from components.base import ports
from components.base.ports import DEVICES, INPUTS, OUTPUTS


@dataclass(frozen=True)
class Params(ports.Params):
    """Those of the component, and when it shall fail."""

    fuse: str = ""
    """Path of a file: once it is there, the next message is one that it can not digest."""


__all__ = ["DEVICES", "INPUTS", "OUTPUTS", "Params"]
