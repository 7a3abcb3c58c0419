"""Says nothing itself: what its device reads is its word."""

from runtime.contract import Event, Output
from tests.pioneer.eyes import ports


class Eyes:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        pass

    def handle(self, event: Event) -> tuple[Output, ...]:
        return ()
