"""A device of text lines on a socket: one number each way."""

import select
import socket

from runtime.contract import DeviceError
from schemas.drive_pb2 import BaseCommand


class Line:
    def __init__(self, params) -> None:
        self._socket = socket.socket(socket.AF_UNIX)
        try:
            self._socket.connect(params.port)
        except OSError as error:
            raise DeviceError(f"line {params.port} can not be opened: {error.strerror}") from None

    def read(self, timeout_s: float):
        if not select.select([self._socket], [], [], timeout_s)[0]:
            return None
        data = self._socket.recv(1)
        if not data:
            raise DeviceError("line was closed")
        return BaseCommand(v_mps=data[0])

    def write(self, message) -> None:
        self._socket.sendall(f"{message.v_mps:g}\n".encode())

    def close(self) -> None:
        self._socket.sendall(b"closed\n")
        self._socket.close()
