"""A gamepad through Linux's joystick interface."""

from __future__ import annotations

import contextlib
import os
import select
import time
from collections import deque

from components.teleop.core import Hand
from components.teleop.ports import Gamepad
from components.teleop.sticks import Sticks
from runtime.contract import DeviceError
from schemas.teleop_pb2 import Hands

_BYTES = 512
"""Read at a time: 64 events."""


class Joystick:
    """A pad whose state is said on every event and whenever it is asked for, so that silence means it is gone."""

    def __init__(self, params: Gamepad) -> None:
        """Open it.

        Raises:
            DeviceError: there is none.
        """
        self._params = params
        self._sticks = Sticks(params)
        self._waiting: deque[Hand] = deque()
        self._heard_s = time.monotonic()
        try:
            self._file = os.open(params.port, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        except OSError as error:
            raise DeviceError(f"gamepad {params.port} can not be opened: {error.strerror}") from None

    def read(self, timeout_s: float) -> Hands:
        """The pad after the next event, or as it is."""
        if not self._waiting:
            self._listen(timeout_s)
        hand = self._waiting.popleft() if self._waiting else self._sticks.now()
        return Hands(dead_man=hand.dead_man, forward=hand.forward, left=hand.left, request=hand.request)  # type: ignore[arg-type]  # an enum's number

    def _listen(self, timeout_s: float) -> None:
        ready = select.select([self._file], [], [], timeout_s)[0]
        if ready:
            self._waiting.extend(self._sticks.feed(self._data()))
            self._heard_s = time.monotonic()
        elif time.monotonic() - self._heard_s > self._params.still_s:
            self._sticks.let_go()

    def _data(self) -> bytes:
        try:
            data = os.read(self._file, _BYTES)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise DeviceError(f"gamepad {self._params.port} can not be read: {error.strerror}") from None
        if not data:
            raise DeviceError(f"gamepad {self._params.port} was closed")
        return data

    def write(self, message: object) -> None:
        """Nothing is told to a gamepad."""

    def close(self) -> None:
        """Let go of it."""
        with contextlib.suppress(OSError):
            os.close(self._file)
