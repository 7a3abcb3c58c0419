"""Pictures from a Unix socket."""

import select
import socket
import struct

from runtime.contract import DeviceError
from schemas.image_pb2 import CompressedImage


class PictureSocket:
    def __init__(self, params):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(params.port)
        self._buffer = b""

    def read(self, timeout_s):
        if select.select([self._socket], [], [], timeout_s)[0]:
            data = self._socket.recv(1 << 16)
            if not data:
                raise DeviceError("the pictures have ended")
            self._buffer += data
        if len(self._buffer) < 4:
            return None
        (size,) = struct.unpack_from("<I", self._buffer)
        if len(self._buffer) < 4 + size:
            return None
        image = CompressedImage(frame_id="camera", format="jpeg", data=self._buffer[4 : 4 + size])
        self._buffer = self._buffer[4 + size :]
        return image

    def write(self, message):
        pass

    def close(self):
        self._socket.close()
