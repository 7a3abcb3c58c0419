"""A world that shows an image once its last one was answered."""

from runtime.contract import STALL, TICK, Event, Output
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import SessionEnd
from tests.runtime.parts.world import ports

FRAME_NS = 125_000_000


class World:
    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        self._params = params
        self._frame = -1

    def handle(self, event: Event) -> tuple[Output, ...]:
        if self._params.clock == "real":
            return self._show(event.time_ns) if event.port == TICK else ()
        first = event.port == TICK and self._frame < 0
        answered = event.port == "drive" and event.capture_ns == self._frame * FRAME_NS
        if not (first or answered or event.port == STALL):
            return ()
        return self._show((self._frame + 1) * FRAME_NS)

    def _show(self, capture_ns: int) -> tuple[Output, ...]:
        self._frame += 1
        if 0 < self._params.frames <= self._frame:
            return (Output("end", SessionEnd(reason="all frames shown")),)
        image = CompressedImage(format="none", data=bytes(self._params.payload_bytes))
        return (Output("image", image, capture_ns),)
