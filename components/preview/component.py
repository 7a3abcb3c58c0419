"""Pictures for another host: the camera's, at a quality and a rate that the link carries."""

from __future__ import annotations

from components.preview import ports
from components.preview.picture import PictureError, smaller
from components.preview.window import FULL, Window
from runtime.contract import Event, Output
from schemas.image_pb2 import CompressedImage

_SECOND_NS = 1_000_000_000


class Preview:
    """Passes pictures on to whoever acknowledges them, a recorder on the other host.

    Nothing on the robot looks at its pictures, so the robot drives by the camera's own whatever the link does.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._waits = params.clock != "lockstep"
        delay_ns, lost_ns = (round(value * _SECOND_NS) for value in (params.delay_s, params.lost_s))
        self._window = Window(delay_ns, lost_ns, params.quality_step, params.least_quality)
        self.refused = 0
        """Pictures that could not be read."""

    def handle(self, event: Event) -> tuple[Output, ...]:
        """See the class."""
        if event.port == "ack":
            self._window.acknowledged(event.capture_ns, event.time_ns)
        if event.port != "image":
            return ()
        if not self._waits:
            return (Output("image", event.message),)
        return self._picture(event) if self._window.opens(event.time_ns) else ()

    def _picture(self, event: Event) -> tuple[Output, ...]:
        image = CompressedImage()
        image.CopyFrom(event.message)
        if self._window.quality < FULL:
            try:
                image.data = smaller(image.data, self._window.quality)
            except PictureError:
                self.refused += 1
                return ()
        self._window.sent(event.capture_ns, event.time_ns)
        return (Output("image", image),)
