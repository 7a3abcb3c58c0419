"""A pan-tilt camera at a serial port of its own, or at a robot's auxiliary port."""

from __future__ import annotations

import contextlib
import sys
import threading
import time

from components.head.camera import Camera, Speech
from components.head.canon import Canon
from components.head.ports import PanTilt
from components.head.visca import Visca
from runtime.contract import DeviceError, Late
from runtime.line import Line, LineError, listen
from schemas.head_pb2 import HeadCommand, HeadState

_REOPEN_S = 0.5
AUX_WAY_S = 0.027
"""At a robot's auxiliary port: two packets before the request and one around it, 26 bytes at 9600 baud."""


class _PanTilt:
    """Never gives up: a line that has ended is opened anew."""

    def __init__(self, speech: Speech, params: PanTilt) -> None:
        self._params = params
        self._is_aux = params.port.startswith("unix:")
        self._turn = threading.Lock()
        self._camera = Camera(speech, params, time.monotonic_ns(), AUX_WAY_S if self._is_aux else 0.0)
        self._line: Line | None = None
        self._reopen_s = 0.0
        try:
            self._line = Line(params.port, params.baud)
        except LineError as error:
            if not self._is_aux:  # base's process, which makes the socket, may come later
                raise DeviceError(f"camera at {error}") from None

    def read(self, timeout_s: float) -> Late | None:
        """The camera's next position, with the time that has passed since it was asked for."""
        until_s = time.monotonic() + timeout_s
        while (left_s := until_s - time.monotonic()) > 0.0:
            with self._turn:
                self._ask()
                if self._camera.readings:
                    pan_rad, tilt_rad, time_ns = self._camera.readings.popleft()
                    age_s = max(0.0, (time.monotonic_ns() - time_ns) * 1e-9)
                    return Late(HeadState(pan_rad=pan_rad, tilt_rad=tilt_rad), age_s)
            listen(self._line, min(left_s, 0.01), self._turn, self._camera.take, self._lose)
        return None

    def write(self, message: HeadCommand) -> None:
        """Look there as soon as the camera has answered what it was asked."""
        with self._turn:
            self._camera.aim(message.pan_rad, message.tilt_rad, message.pan_rate_radps, message.tilt_rate_radps)

    def close(self) -> None:
        """Let go of it; it stands where it was told to."""
        with self._turn:
            if self._line is not None:
                self._line.close()
                self._line = None

    def _ask(self) -> None:
        while self._camera.words:
            sys.stdout.write(f"camera at {self._params.port}: {self._camera.words.popleft()}\n")
            sys.stdout.flush()
        if self._line is None:
            self._open()
        request = self._camera.request(time.monotonic_ns())
        if request is None or self._line is None:
            return
        header = bytes((request.answer_bytes, len(request.content))) if self._is_aux else b""
        try:
            self._line.write(header + request.content)
        except LineError as error:
            self._lose(error)

    def _lose(self, error: LineError) -> None:
        if self._line is None:
            return
        self._camera.words.append(f"{error}; opening it again")
        self._line.close()
        self._line = None
        self._reopen_s = time.monotonic() + _REOPEN_S

    def _open(self) -> None:
        if time.monotonic() < self._reopen_s:
            return
        self._reopen_s = time.monotonic() + _REOPEN_S
        with contextlib.suppress(LineError):
            self._line = Line(self._params.port, self._params.baud)
            self._camera.begin(time.monotonic_ns())


class CanonVcC4(_PanTilt):
    """Canon VC-C4 and VC-C50i."""

    def __init__(self, params: PanTilt) -> None:
        """Open its line."""
        super().__init__(Canon(), params)


class SonyEviD30(_PanTilt):
    """Sony EVI-D30 and D31."""

    def __init__(self, params: PanTilt) -> None:
        """Open its line."""
        super().__init__(Visca(), params)
