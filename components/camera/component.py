"""The camera as a component: what its device reads is its word."""

from __future__ import annotations

from components.camera import ports
from runtime.contract import Event, Output


class Camera:
    """Passes frames on. Without a device it says nothing, and `berth play --replace camera` can stand in for it."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del params, seed  # there is nothing to choose yet

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Pass a frame on."""
        return (Output("image", event.message),) if event.port == "device" else ()
