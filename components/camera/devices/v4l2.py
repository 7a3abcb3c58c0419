"""A camera of the Linux kernel, through OpenCV."""

from __future__ import annotations

import os
import time
from typing import NamedTuple

import cv2
import numpy as np

from components.camera.devices.source import Watched
from components.camera.header import PictureError
from components.camera.picture import encoded
from components.camera.ports import V4l2
from runtime.contract import DeviceError

_WAIT_S = "1"
"""A camera that shows nothing for so long is opened anew. OpenCV's own wait is 10 s, in whole seconds."""
_STAMP_MAX_NS = 2_000_000_000
"""A driver's stamp further from now than this is of another clock."""
_EXPOSURE_UNIT_S = 1e-4
"""Of V4L2_CID_EXPOSURE_ABSOLUTE."""
_MANUAL = 1
"""V4L2_EXPOSURE_MANUAL."""
_MJPEG = cv2.VideoWriter.fourcc(*"MJPG")


class _Control(NamedTuple):
    """A property that the camera is to have."""

    name: str
    property: int
    value: float
    automatic: int = -1
    """Property that is switched to `manual` first; -1 = none."""
    manual: float = 0.0


class _Capture:
    """The opened camera."""

    waits = False

    def __init__(self, params: V4l2) -> None:
        self._params = params
        os.environ.setdefault("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", _WAIT_S)
        cv2.setNumThreads(1)
        self._capture = cv2.VideoCapture(params.port, cv2.CAP_V4L2)
        if not self._capture.isOpened():
            raise DeviceError(f"can not be opened: {_why(params.port)}")
        try:
            self._choose_format()
        except DeviceError:
            self._capture.release()
            raise
        self.unkept = [control.name for control in _controls(params) if not self._has(control)]

    def _choose_format(self) -> None:
        """MJPEG as it comes, if the camera has it."""
        params, capture = self._params, self._capture
        capture.set(cv2.CAP_PROP_FOURCC, _MJPEG)
        capture.set(cv2.CAP_PROP_FRAME_WIDTH, params.width_px)
        capture.set(cv2.CAP_PROP_FRAME_HEIGHT, params.height_px)
        capture.set(cv2.CAP_PROP_FPS, params.camera_hz)
        self._passes = int(capture.get(cv2.CAP_PROP_FOURCC)) == _MJPEG
        capture.set(cv2.CAP_PROP_CONVERT_RGB, 0.0 if self._passes else 1.0)
        asked = f"{params.width_px}x{params.height_px}"
        has = f"{capture.get(cv2.CAP_PROP_FRAME_WIDTH):.0f}x{capture.get(cv2.CAP_PROP_FRAME_HEIGHT):.0f}"
        if has != asked:
            raise DeviceError(f"must offer {asked} px; it offers {has}")

    def _has(self, control: _Control) -> bool:
        """Set a property, and look whether it stays."""
        if control.automatic >= 0:
            self._capture.set(control.automatic, control.manual)
        self._capture.set(control.property, control.value)
        return abs(self._capture.get(control.property) - control.value) <= 0.02 * abs(control.value)

    def grab(self) -> int:
        """Wait for a frame. The driver stamps it when it begins or ends, on the monotonic clock."""
        if not self._capture.grab():
            raise DeviceError("shows nothing any more")
        now_ns = time.monotonic_ns()
        stamp_ns = round(self._capture.get(cv2.CAP_PROP_POS_MSEC) * 1e6)
        return stamp_ns if 0 <= now_ns - stamp_ns < _STAMP_MAX_NS else now_ns

    def picture(self) -> bytes:
        """The camera's own JPEG."""
        try:
            done, image = self._capture.retrieve()
        except cv2.error:  # fewer bytes than the format has
            done, image = False, None
        if not done or image is None or not image.size:
            raise PictureError("it is empty or cut short")
        pixels = np.asarray(image, np.uint8)
        return pixels.tobytes() if self._passes else encoded(pixels)

    def close(self) -> None:
        """Let go of it."""
        self._capture.release()


def _controls(params: V4l2) -> list[_Control]:
    """What is asked for."""
    exposure = max(1.0, round(params.exposure_s / _EXPOSURE_UNIT_S))
    kelvin, gain = params.white_balance_k, float(params.gain)
    found = []
    if params.exposure_s > 0.0:
        found.append(_Control("exposure", cv2.CAP_PROP_EXPOSURE, exposure, cv2.CAP_PROP_AUTO_EXPOSURE, _MANUAL))
    if kelvin > 0.0:
        found.append(_Control("white balance", cv2.CAP_PROP_WB_TEMPERATURE, kelvin, cv2.CAP_PROP_AUTO_WB))
    if gain >= 0.0:
        found.append(_Control("gain", cv2.CAP_PROP_GAIN, gain))
    return found


def _why(port: str) -> str:
    try:
        os.close(os.open(port, os.O_RDWR | os.O_NONBLOCK))
    except OSError as error:
        return error.strerror or str(error)
    return "it is no camera that V4L2 knows, or another program has it"


class V4l2Camera(Watched):
    """As a device."""

    def __init__(self, params: V4l2) -> None:
        """Open it. Raises DeviceError."""
        self._params = params
        super().__init__(params.port, params.hz, self._capture)

    def _capture(self) -> _Capture:
        capture = _Capture(self._params)
        if capture.unkept:
            self._say(f"does not keep its {' and '.join(capture.unkept)}; colours may change with the light")
        return capture
