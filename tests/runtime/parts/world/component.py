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
        self._answered = -1
        self._recorded = -1

    def handle(self, event: Event) -> tuple[Output, ...]:
        if self._params.clock == "real":
            return self._show(event.time_ns) if event.port == TICK else ()
        if event.port == "drive" and event.capture_ns == self._frame * FRAME_NS:
            self._answered = self._frame
        elif event.port == "ack":
            self._recorded = max(self._recorded, event.capture_ns // FRAME_NS)
        first = event.port == TICK and self._frame < 0
        if not (first or event.port == STALL or (event.port in {"drive", "ack"} and self._is_next_due())):
            return ()
        return self._show((self._frame + 1) * FRAME_NS)

    def _is_next_due(self) -> bool:
        held_back = 0 < self._params.window <= self._frame - self._recorded
        return self._answered == self._frame >= 0 and not held_back

    def _show(self, capture_ns: int) -> tuple[Output, ...]:
        self._frame += 1
        if 0 < self._params.frames <= self._frame:
            return (Output("end", SessionEnd(reason="all frames shown")),)
        image = CompressedImage(format="none", data=bytes(self._params.payload_bytes))
        return (Output("image", image, capture_ns),)
