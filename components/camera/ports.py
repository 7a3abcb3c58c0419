"""Frames for the eyes: from a device, or from a session that is played in its place: parameters, devices and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from runtime.contract import DeviceKind, Input, Kind, Port
from runtime.params import between, not_negative, ruled
from schemas.image_pb2 import CompressedImage


@dataclass(frozen=True)
class Params:
    """Parameters of this component: its device has them all."""


def _width() -> int:
    return ruled(320, "a multiple of 8 between 64 and 1920", lambda px: 64 <= px <= 1920 and px % 8 == 0)


def _height() -> int:
    return ruled(240, "a multiple of 8 between 48 and 1440", lambda px: 48 <= px <= 1440 and px % 8 == 0)


@dataclass(frozen=True)
class V4l2:
    """`device = { kind = "v4l2", port = "/dev/video0" }`: a camera of the Linux kernel, such as one at USB."""

    port: str = ruled("/dev/video0", "a path", bool)
    """Device file. A camera that is plugged in again may get another number: /dev/v4l/by-id/... stays."""
    width_px: int = _width()
    """Of the image; the camera must offer it, and `vision.width_px` must be the same."""
    height_px: int = _height()
    """As above."""
    hz: float = between(8.0, 0.1, 120.0)
    """Frames a second that are passed on; of those between the camera's own are left out."""
    camera_hz: float = between(30.0, 0.1, 240.0)
    """Frames a second that the camera is asked for. A fast one answers early: a frame is half a period old."""
    exposure_s: float = not_negative(0.01)
    """Fixed exposure: colours and motion blur stay the same. 0 = as the camera likes."""
    white_balance_k: float = ruled(4000.0, "0 or between 1000 and 20000", lambda k: k == 0.0 or 1e3 <= k <= 2e4)
    """Fixed white balance. 0 = as the camera likes; then learned colours do not last."""
    gain: int = between(-1, -1, 100_000)
    """Fixed gain, in the camera's own unit; -1 = as it is."""


@dataclass(frozen=True)
class Video:
    """`device = { kind = "video", port = "walk.mp4" }`: a video file, at the speed at which it was taken."""

    port: str = ruled("video.mp4", "a path", bool)
    """File; whatever FFmpeg reads."""
    width_px: int = _width()
    """Frames are scaled to this; `vision.width_px` must be the same."""
    height_px: int = _height()
    """As above; the shape must be the video's own."""
    hz: float = between(8.0, 0.1, 120.0)
    """Frames a second that are passed on."""
    loop: bool = True
    """Begin again at the end; else nothing more comes."""


@dataclass(frozen=True)
class Folder:
    """`device = { kind = "folder", port = "images" }`: JPEGs and PNGs, in the order of the numbers in their names."""

    port: str = ruled("images", "a path", bool)
    """Folder."""
    width_px: int = _width()
    """Other images are scaled to this; `vision.width_px` must be the same."""
    height_px: int = _height()
    """As above; images of another shape are left out."""
    hz: float = between(8.0, 0.1, 120.0)
    """Images a second."""
    loop: bool = True
    """Begin again at the end; else nothing more comes."""


DEVICES: Mapping[str, DeviceKind] = {
    "v4l2": DeviceKind("components.camera.devices.v4l2:V4l2Camera", V4l2),
    "video": DeviceKind("components.camera.devices.video:VideoFile", Video),
    "folder": DeviceKind("components.camera.devices.folder:ImageFolder", Folder),
}
INPUTS: Mapping[str, Input] = {}
OUTPUTS: Mapping[str, Port] = {"device": Port(CompressedImage, Kind.IMAGE, hz=8, per_frame=True)}
"""Launch files name it what it is: `outputs = { device = "camera/image" }`."""
