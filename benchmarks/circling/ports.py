"""Drives in a circle: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import Input, Kind, Port
from schemas.drive_pb2 import BaseState, Drive


@dataclass(frozen=True)
class Params:
    """It has none."""


INPUTS: Mapping[str, Input] = {"base": Port(BaseState)}
OUTPUTS: Mapping[str, Port] = {"drive": Port(Drive, Kind.COMMAND, on=("base",))}
