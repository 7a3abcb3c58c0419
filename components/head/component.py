"""Pan-tilt unit driver: the device's encoders to `state`, the tracker's aim within the unit's limits to `actuate`."""

from __future__ import annotations

import math

from components.head import ports
from components.head.core import Motion, limited, readable, wired
from runtime.contract import Event, Output
from schemas.head_pb2 import HeadCommand, HeadState


class Head:
    """Answers every aim with one command and every reading with one state, oldest capture first, none twice.

    Encoders that can not be read are NaN in `state`: a made-up angle would become a wrong bearing.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        self._held = Motion(0.0, 0.0)  # where the head was last read or told to be
        self._answered_ns = {"aim": -1, "device": -1}

    def handle(self, event: Event) -> tuple[Output, ...]:
        """One output for each new frame on `aim` and on `device`."""
        if event.port not in self._answered_ns or event.capture_ns <= self._answered_ns[event.port]:
            return ()
        self._answered_ns[event.port] = event.capture_ns
        return (self._state(event.message) if event.port == "device" else self._actuate(event.message),)

    def _state(self, reading: HeadState) -> Output:
        pan_rad = self._params.pan_encoder_scale * reading.pan_rad
        tilt_rad = self._params.tilt_encoder_scale * reading.tilt_rad
        if not readable(pan_rad, tilt_rad):
            return Output("state", HeadState(pan_rad=math.nan, tilt_rad=math.nan))
        self._held = Motion(pan_rad, tilt_rad)
        return Output("state", HeadState(pan_rad=pan_rad, tilt_rad=tilt_rad))

    def _actuate(self, aim: HeadCommand) -> Output:
        wish = Motion(aim.pan_rad, aim.tilt_rad, aim.pan_rate_radps, aim.tilt_rate_radps)
        self._held = limited(wish, self._held, self._params)
        return Output("actuate", HeadCommand(**wired(self._held, self._params)._asdict()))
