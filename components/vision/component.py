"""The eyes as a component: one view for each image, whatever the image is."""

from __future__ import annotations

from components.vision import core, jpeg, ports
from runtime.contract import Event, Output
from schemas.view_pb2 import View


class Vision:
    """Stateless: the same image gives the same view."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:  # noqa: ARG002 - nothing is left to chance here
        self._params = params
        self._eyes = core.Eyes(params)

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Answer an image."""
        if event.port != "image":
            return ()
        try:
            image = jpeg.decode(event.message.data, self._params.width_px, self._params.height_px)
        except jpeg.JpegError as error:
            return (Output("view", View(fault=str(error))),)
        return (Output("view", view(self._eyes.look(image))),)


def view(sight: core.Sight) -> View:
    """As a message."""
    message = View()
    if sight.spot is not None:
        message.object_visible = True
        message.object_u_px, message.object_v_px, message.object_pixels = sight.spot
    if sight.border is not None:
        message.edge_visible = True
        message.edge_slope, message.edge_v_px, message.edge_pixels = sight.border
    return message
