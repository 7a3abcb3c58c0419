"""The robot's auxiliary serial port for another process on this machine, through base's line: for a camera's driver.

A request is the number of bytes that the answer will have, the number of its own bytes, and these. Answers are the
bytes as they come. One driver at a time; the newest one counts.
"""

from __future__ import annotations

import contextlib
import os
import socket
from collections import deque
from pathlib import Path
from typing import Protocol

from runtime.contract import DeviceError

_BYTES = 4096


class Speaker(Protocol):
    """The robot's client, as far as it matters here."""

    answers: deque[bytes]

    def ask(self, content: bytes, answer_bytes: int) -> None: ...  # noqa: D102


class AuxSocket:
    """A Unix socket that only this user can open. Never waits."""

    def __init__(self, path: str) -> None:
        """Make it.

        Raises:
            DeviceError: it can not be made.
        """
        self._path = Path(path)
        self._guest: socket.socket | None = None
        self._part = b""
        self._listener = socket.socket(socket.AF_UNIX)
        before = os.umask(0o177)
        try:
            if self._path.is_socket():  # of a process that was killed; never somebody's file
                self._path.unlink()
            self._listener.bind(path)
        except OSError as error:
            raise DeviceError(f"aux {path} can not be made: {error.strerror or error}") from None
        finally:
            os.umask(before)
        self._listener.listen(1)
        self._listener.setblocking(False)

    def exchange(self, client: Speaker) -> None:
        """Carry requests to the robot and answers back."""
        with contextlib.suppress(BlockingIOError):
            guest, _ = self._listener.accept()
            guest.setblocking(False)
            self._leave()
            self._guest = guest
        if self._guest is None:
            return
        try:
            self._carry(client, self._guest)
        except OSError:
            self._leave()

    def close(self) -> None:
        """Remove it."""
        self._leave()
        self._listener.close()
        self._path.unlink(missing_ok=True)

    def _carry(self, client: Speaker, guest: socket.socket) -> None:
        with contextlib.suppress(BlockingIOError):
            data = guest.recv(_BYTES)
            if not data:
                self._leave()
                return
            self._part += data
        while len(self._part) >= 2 and len(self._part) >= 2 + self._part[1]:
            end = 2 + self._part[1]
            client.ask(self._part[2:end], self._part[0])
            self._part = self._part[end:]
        answers = client.answers
        while answers:
            guest.send(answers.popleft())

    def _leave(self) -> None:
        if self._guest is not None:
            self._guest.close()
        self._guest, self._part = None, b""
