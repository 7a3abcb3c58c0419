"""Closing a connection must not wait for its other end.

Zenoh lets each of its TCP connections linger for 10 s and closes them on its own thread. A connection to a dead link
holds data that nobody will confirm, so closing it stops everything that this thread carries: 10 s, or until the link is
back (measured; zenoh issues 1101 and 2350, open). Without lingering the system delivers what is left in the background.
"""

from __future__ import annotations

import os
import socket
import stat
import struct
import time
from functools import cache
from threading import Thread

_OFF = struct.pack("ii", 0, 0)
"""`struct linger`: l_onoff, l_linger in seconds."""
_OPEN_FILES = "/dev/fd"
_PERIOD_S = 0.4
"""No connection is given up sooner: a lease and an attempt to connect last 1 s."""


@cache
def keep_from_lingering() -> Thread:
    """Let no connection of this process linger, as long as it lives: zenoh makes new ones at any time."""
    thread = Thread(target=_keep, name="lingering", daemon=True)
    thread.start()
    return thread


def forbid_lingering() -> None:
    """Let no connection linger that this process has now."""
    for name in os.listdir(_OPEN_FILES):  # noqa: PTH208  (numbers, not paths)
        _forbid(int(name))


def _keep() -> None:
    while True:
        forbid_lingering()
        time.sleep(_PERIOD_S)


def _forbid(descriptor: int) -> None:
    """Zenoh may close it meanwhile; then nothing is done, or it is done to what has taken its number."""
    try:
        if not stat.S_ISSOCK(os.fstat(descriptor).st_mode):
            return
        borrowed = socket.socket(fileno=descriptor)
    except OSError:
        return
    try:
        borrowed.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _OFF)
    except OSError:
        return
    finally:
        borrowed.detach()
