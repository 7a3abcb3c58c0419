"""A video file, at its own speed."""

from __future__ import annotations

import time
from pathlib import Path

import cv2
import numpy as np

from components.camera.devices.source import EndError, Watched
from components.camera.header import PictureError, check
from components.camera.picture import check_shape, encoded, scaled
from components.camera.ports import Video
from runtime.contract import DeviceError


class _Film:
    """The opened file."""

    waits = True

    def __init__(self, params: Video) -> None:
        self._params = params
        self._size = params.width_px, params.height_px
        cv2.setNumThreads(1)
        if not Path(params.port).is_file():
            raise DeviceError("can not be opened: it is no file")
        self._capture = cv2.VideoCapture(params.port, cv2.CAP_FFMPEG)
        if not self._capture.isOpened():
            raise DeviceError("can not be used: no video that FFmpeg knows")
        try:
            check(*(found := (self._has(cv2.CAP_PROP_FRAME_WIDTH), self._has(cv2.CAP_PROP_FRAME_HEIGHT))))
            check_shape(found, self._size)
        except PictureError as error:
            self._capture.release()
            raise DeviceError(f"can not be used: {error}") from None
        self._period_ns = round(1e9 / max(1, self._has(cv2.CAP_PROP_FPS)))
        self._begun_ns = -1
        self._newest_ns = -1

    def _has(self, property_: int) -> int:
        return round(self._capture.get(property_))

    def grab(self) -> int:
        """The next frame, at its time from the beginning of the file."""
        if not self._capture.grab():
            self._again()
        position_ns = round(max(0.0, self._capture.get(cv2.CAP_PROP_POS_MSEC)) * 1e6)
        if self._begun_ns < 0:
            self._begun_ns = max(time.monotonic_ns(), self._newest_ns + self._period_ns) - position_ns
        self._newest_ns = self._begun_ns + position_ns
        return self._newest_ns

    def _again(self) -> None:
        if not self._params.loop or self._begun_ns < 0:
            raise EndError
        self._capture.release()
        self._begun_ns = -1
        if not (self._capture.open(self._params.port, cv2.CAP_FFMPEG) and self._capture.grab()):
            raise DeviceError("can not be read any more")

    def picture(self) -> bytes:
        """As a JPEG of the size asked for."""
        done, image = self._capture.retrieve()
        if not done or image is None:
            raise PictureError("damaged")
        return encoded(scaled(np.asarray(image, np.uint8), self._size))

    def close(self) -> None:
        """Let go of it."""
        self._capture.release()


class VideoFile(Watched):
    """As a device."""

    def __init__(self, params: Video) -> None:
        """Open it. Raises DeviceError."""
        super().__init__(params.port, params.hz, lambda: _Film(params))
