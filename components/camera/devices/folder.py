"""A folder of images, at a steady rate."""

from __future__ import annotations

import re
import time
from pathlib import Path

import cv2

from components.camera.devices.source import EndError, Watched
from components.camera.header import PictureError
from components.camera.picture import BYTES_MAX, as_jpeg
from components.camera.ports import Folder
from runtime.contract import DeviceError

SUFFIXES = frozenset({".jpg", ".jpeg", ".png"})


class _Album:
    """The images of a folder, `frame2` before `frame10`."""

    waits = True

    def __init__(self, params: Folder) -> None:
        self._params = params
        cv2.setNumThreads(1)
        try:
            files = [file for file in Path(params.port).iterdir() if file.suffix.lower() in SUFFIXES]
        except OSError as error:
            raise DeviceError(f"can not be read: {error.strerror}") from None
        if not files:
            raise DeviceError(f"must hold images: {', '.join(sorted(SUFFIXES))}")
        self._files = sorted(files, key=natural)
        self._check()
        self._at = -1
        self._newest_ns = 0

    def _check(self) -> None:
        """Refuse a folder in which nothing can be used; the first reason stands for all."""
        reason = None
        for file in self._files:
            try:
                self._jpeg(file)
            except PictureError as error:
                reason = reason or error
            else:
                return
        raise DeviceError(f"must hold images that can be used; {reason}")

    def grab(self) -> int:
        """The next image, a period after the one before."""
        if self._at + 1 == len(self._files) and not self._params.loop:
            raise EndError
        self._at = (self._at + 1) % len(self._files)
        self._newest_ns = max(self._newest_ns + round(1e9 / self._params.hz), time.monotonic_ns())
        return self._newest_ns

    def picture(self) -> bytes:
        """Its bytes, if it is a JPEG of the size asked for."""
        return self._jpeg(self._files[self._at])

    def _jpeg(self, file: Path) -> bytes:
        try:
            return as_jpeg(_content(file), (self._params.width_px, self._params.height_px))
        except PictureError as error:
            raise PictureError(f"{file.name}: {error}") from None

    def close(self) -> None:
        """Nothing is held."""


def _content(file: Path) -> bytes:
    try:
        if not file.is_file() or file.stat().st_size > BYTES_MAX:
            raise PictureError("no file, or too many bytes")
        return file.read_bytes()
    except OSError as error:
        raise PictureError(f"can not be read: {error.strerror}") from None


def natural(file: Path) -> list[tuple[int, str]]:
    """Sorting key that reads numbers as numbers."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"([0-9]+)", file.name)]


class ImageFolder(Watched):
    """As a device."""

    def __init__(self, params: Folder) -> None:
        """Open it. Raises DeviceError."""
        super().__init__(params.port, params.hz, lambda: _Album(params))
