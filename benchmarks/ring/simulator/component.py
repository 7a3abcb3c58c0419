"""Stands in for `components.simulator`: the next frame when the last one is answered."""

from __future__ import annotations

from benchmarks.ring.simulator import ports
from runtime.contract import STALL, STOP, TICK, Event, Output
from schemas.image_pb2 import CompressedImage
from schemas.session_pb2 import SessionEnd

FRAME_NS = 125_000_000
_ACKS_BEHIND = 16


class Simulator:
    """Computes nothing."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:  # noqa: ARG002
        """Frame 0 is shown at the first tick."""
        self._params = params
        self._frame = -1
        self._acked = -1
        self._answers: set[str] = set()

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Collect the answers to the frame that is shown."""
        if event.port == "ack":
            self._acked = event.capture_ns // FRAME_NS
        elif event.port in {"drive", "aim", "trial"} and event.capture_ns == self._frame * FRAME_NS:
            self._answers.add(event.port)
        elif event.port in {STALL, STOP} or (event.port == TICK and self._frame >= 0):
            return ()
        answered = self._frame < 0 or (len(self._answers) == 3 and self._acked >= self._frame - _ACKS_BEHIND)
        return self._show() if answered and self._frame < self._params.frames else ()

    def _show(self) -> tuple[Output, ...]:
        self._frame += 1
        self._answers.clear()
        capture_ns = self._frame * FRAME_NS
        if self._frame == self._params.frames:
            return (Output("end", SessionEnd(reason="all frames shown"), capture_ns),)
        image = CompressedImage(format="none", data=bytes(self._params.image_bytes))
        others = (Output(name, self.outputs[name].schema(), capture_ns) for name in ("head", "base", "truth"))
        return (Output("image", image, capture_ns), *others)
