"""Keys of a terminal, one by one as they are pressed."""

from __future__ import annotations

import os
import select
import sys
import termios
import threading
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

GONE = ""
"""Not a key: the terminal has gone, nobody will press one any more."""
_SLICE_S = 0.1


@contextmanager
def pressed(call: Callable[[str], None]) -> Iterator[bool]:
    """Call with each key (an arrow is its escape sequence), on a thread of its own; yields whether there is a terminal.

    The terminal is given back as it was. When it goes away, the last call is with `GONE`.
    """
    if not sys.stdin.isatty():
        yield False
        return
    handle = sys.stdin.fileno()
    before = termios.tcgetattr(handle)
    done = threading.Event()
    reader = threading.Thread(target=_read, args=(handle, call, done), daemon=True)
    try:
        tty.setcbreak(handle, termios.TCSADRAIN)  # Ctrl-C stays a signal; what was typed already counts
        reader.start()
        yield True
    finally:
        done.set()
        reader.join(2 * _SLICE_S)
        with suppress(termios.error):  # it has gone
            termios.tcsetattr(handle, termios.TCSADRAIN, before)


def _read(handle: int, call: Callable[[str], None], done: threading.Event) -> None:
    while not done.is_set():
        if select.select([handle], [], [], _SLICE_S)[0]:
            data = _typed(handle)
            call(data.decode(errors="replace") if data else GONE)
            if not data:
                return


def _typed(handle: int) -> bytes:
    """What was typed; empty when the terminal has hung up."""
    try:
        return os.read(handle, 8)
    except OSError:
        return b""
