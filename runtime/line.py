"""A line of bytes to a device: a serial port, `tcp://HOST:PORT`, or `unix:PATH`. Never waits to write."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import termios
import threading
import time
from collections.abc import Callable
from urllib.parse import urlsplit

import serial

from runtime.contract import DeviceError

_BYTES = 4096
_CONNECT_S = 0.5
"""A host that does not answer within this is told as gone."""


class LineError(DeviceError):
    """The line can not be opened, or has ended; in words."""


class Line:
    """Opened by its maker, closed by `close`."""

    def __init__(self, port: str, baud: int) -> None:
        """Open it.

        Args:
            port: a serial port's path, `tcp://HOST:PORT` or `unix:PATH`.
            baud: of a serial port.

        Raises:
            LineError: it can not be opened.
        """
        self.port = port
        self._unsent = b""
        try:
            self._end: serial.Serial | socket.socket = _opened(port, baud)
            self._file = self._end.fileno()
            os.set_blocking(self._file, False)
        except (OSError, ValueError, termios.error) as error:
            raise LineError(f"{port} can not be opened: {_reason(error)}") from None

    def read(self, timeout_s: float) -> bytes:
        """What has come; nothing after the timeout.

        Raises:
            LineError: the line has ended.
        """
        try:
            if not select.select([self._file], [], [], timeout_s)[0]:
                return b""
            data = os.read(self._file, _BYTES)
        except BlockingIOError:
            return b""
        except (OSError, ValueError) as error:
            raise LineError(f"{self.port} has ended: {_reason(error)}") from None
        if not data:
            raise LineError(f"{self.port} has ended")
        return data

    def write(self, data: bytes) -> None:
        """Send without waiting; what the line does not take now goes first next time.

        Raises:
            LineError: the line has ended, or takes nothing any more.
        """
        self._unsent += data
        try:
            self._unsent = self._unsent[os.write(self._file, self._unsent) :]
        except BlockingIOError:
            pass
        except (OSError, ValueError) as error:
            raise LineError(f"{self.port} has ended: {_reason(error)}") from None
        if len(self._unsent) > _BYTES:
            raise LineError(f"{self.port} takes no more bytes")

    def close(self) -> None:
        """Let go of it, whatever is still unsent."""
        with contextlib.suppress(OSError):
            self._end.close()


def listen(
    line: Line | None,
    timeout_s: float,
    turn: threading.Lock,
    take: Callable[[bytes, int], None],
    lose: Callable[[LineError], None],
) -> None:
    """Wait for bytes, and meanwhile let another thread write.

    Args:
        line: None = there is none at the moment; the time passes all the same.
        timeout_s: longest wait.
        turn: held while `take` or `lose` is called, not while waiting.
        take: gets the bytes, and the monotonic time in ns.
        lose: gets the reason why the line has ended.
    """
    if line is None:
        time.sleep(timeout_s)
        return
    try:
        data = line.read(timeout_s)
    except LineError as error:
        with turn:
            lose(error)
        return
    if data:
        with turn:
            take(data, time.monotonic_ns())


def _opened(port: str, baud: int) -> serial.Serial | socket.socket:
    if port.startswith("tcp://"):
        place = urlsplit(port)
        end = socket.create_connection((place.hostname, place.port), _CONNECT_S)
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return end
    if port.startswith("unix:"):
        local = socket.socket(socket.AF_UNIX)
        local.connect(port.removeprefix("unix:"))
        return local
    return serial.Serial(port, baud, timeout=0, write_timeout=0, exclusive=True)


def _reason(error: Exception) -> str:
    number = getattr(error, "errno", None)
    return os.strerror(number) if isinstance(number, int) else str(error) or type(error).__name__
