"""Sends images and small messages at fixed mean rates."""

from __future__ import annotations

import random

from benchmarks.ring.flood import ports
from runtime.contract import TICK, Event, Output
from schemas.image_pb2 import CompressedImage
from schemas.percept_pb2 import Percept
from schemas.session_pb2 import SessionEnd


class Flood:
    """Makes up for late ticks: the mean rates hold on a busy machine too."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        """Make the image: random bytes, which do not compress, as those of a JPEG."""
        self._params = params
        self._image = random.Random(seed).randbytes(params.image_bytes)
        self._sent = {"image": 0, "small": 0}
        self._began_ns = -1

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Send what is due."""
        if event.port != TICK:
            return ()
        if self._began_ns < 0:
            self._began_ns = event.time_ns  # the time until all were ready is not made up for
        time_s = (event.time_ns - self._began_ns) / 1e9
        if time_s >= self._params.duration_s:
            return (Output("end", SessionEnd(reason="all sent")),)
        small = [Output("small", self._percept(event.time_ns))] * self._due("small", ports.SMALL_HZ * time_s)
        image = CompressedImage(frame_id="camera", format="jpeg", data=self._image)
        return (*small, *[Output("image", image)] * self._due("image", ports.IMAGE_HZ * time_s, most=1))

    def _due(self, port: str, count: float, most: int = ports.SMALL_HZ) -> int:
        """A camera never gives several images in one instant."""
        due = min(most, int(count) - self._sent[port])
        self._sent[port] += due
        return due

    @staticmethod
    def _percept(time_ns: int) -> Percept:
        return Percept(
            visible=True, slope=time_ns % 977 / 977, pan_rad=time_ns % 991 / 991, tilt_rad=0.3, capture_time_ns=time_ns
        )
