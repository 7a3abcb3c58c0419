"""Wants the base for itself once a trial has ended."""

from dataclasses import dataclass

from runtime.contract import Kind, Port
from schemas.drive_pb2 import BaseState, Drive
from schemas.trial_pb2 import Trial


@dataclass(frozen=True)
class Params:
    pass


INPUTS = {"base": Port(BaseState), "trial": Port(Trial, Kind.EVENT)}
OUTPUTS = {"drive": Port(Drive, Kind.COMMAND, on=("base",))}
