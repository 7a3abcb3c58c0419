"""Hears nothing and says nothing."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Params:
    pass


INPUTS: dict = {}
OUTPUTS: dict = {}
