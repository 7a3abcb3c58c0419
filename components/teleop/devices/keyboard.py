"""The keys of a terminal, one by one as they are pressed."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import termios
import tty
from collections import deque

from components.teleop.core import Hand
from components.teleop.keys import Keys
from components.teleop.ports import Keyboard
from runtime.contract import DeviceError
from schemas.teleop_pb2 import Hands

_BYTES = 64
"""Read at a time."""


class Terminal:
    """A terminal without echo whose keys arrive at once; Ctrl-C still interrupts. It is given back as it was."""

    def __init__(self, params: Keyboard) -> None:
        """Open it.

        Raises:
            DeviceError: it is no terminal, or not ours to read.
        """
        self._port = params.port
        self._keys = Keys()
        self._waiting: deque[Hand] = deque()
        # In the background a read fails then, and is told, instead of stopping the process for ever.
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)
        signal.signal(signal.SIGTTOU, signal.SIG_IGN)
        try:
            self._file = os.open(params.port, os.O_RDWR | os.O_NOCTTY | os.O_CLOEXEC)
        except OSError as error:
            raise DeviceError(f"keyboard {params.port} can not be opened: {error.strerror}") from None
        try:
            self._before = termios.tcgetattr(self._file)
            tty.setcbreak(self._file, termios.TCSANOW)
        except termios.error:
            os.close(self._file)
            raise DeviceError(f"keyboard {params.port} must be a terminal") from None

    def read(self, timeout_s: float) -> Hands | None:
        """The next key."""
        if not self._waiting:
            self._waiting.extend(self._more(timeout_s))
        if not self._waiting:
            return None
        hand = self._waiting.popleft()
        return Hands(dead_man=hand.dead_man, forward=hand.forward, left=hand.left, request=hand.request)  # type: ignore[arg-type]  # an enum's number

    def _more(self, timeout_s: float) -> list[Hand]:
        if not select.select([self._file], [], [], timeout_s)[0]:
            return self._keys.flush()
        try:
            data = os.read(self._file, _BYTES)
        except OSError as error:
            raise DeviceError(f"keyboard {self._port} can not be read: {error.strerror}") from None
        if not data:
            raise DeviceError(f"keyboard {self._port} was closed")
        return self._keys.feed(data)

    def write(self, message: object) -> None:
        """Nothing is told to a keyboard."""

    def close(self) -> None:
        """Give the terminal back."""
        with contextlib.suppress(termios.error, OSError):
            termios.tcsetattr(self._file, termios.TCSANOW, self._before)
        with contextlib.suppress(OSError):
            os.close(self._file)
