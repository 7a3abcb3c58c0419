"""The camera as a component: what its device reads is its word."""

from __future__ import annotations

from components.camera import ports
from runtime.contract import Event, Output


class Camera:
    """Says nothing itself: the shell publishes what its device reads.

    Without a device nothing comes, and `berth play --replace camera` can stand in for it.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del params, seed  # there is nothing to choose

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Only the end is handed over."""
        del event
        return ()
