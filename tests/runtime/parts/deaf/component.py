"""Hears nothing and says nothing."""

from runtime.contract import Event, Output
from tests.runtime.parts.deaf import ports


class Deaf:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        pass

    def handle(self, event: Event) -> tuple[Output, ...]:
        return ()
