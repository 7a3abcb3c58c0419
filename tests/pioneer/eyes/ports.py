"""As the camera's, with a device that reads pictures from a socket: length, then JPEG."""

from dataclasses import dataclass

from runtime.contract import DeviceKind, Kind, Port
from schemas.image_pb2 import CompressedImage


@dataclass(frozen=True)
class Params:
    pass


@dataclass(frozen=True)
class Pictures:
    port: str = ""


DEVICES = {"pictures": DeviceKind("tests.pioneer.eyes.pictures:PictureSocket", Pictures)}
INPUTS = {}
OUTPUTS = {"device": Port(CompressedImage, Kind.IMAGE, hz=8)}
