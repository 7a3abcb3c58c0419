"""Zenoh's threads call into Python without being Python's: their interpreter state is made once, not per call.

CPython 3.11 makes a thread state at each such call and unmaps its stack after it, which costs more than all that is
done in between (measured: a third of the time of a process that receives).
"""

from __future__ import annotations

import ctypes
import threading


class ForeignThreads:
    """Remembers the threads whose state is kept."""

    def __init__(self) -> None:
        """None yet."""
        self._kept: set[int] = set()

    def keep(self) -> None:
        """Called on a foreign thread: keep its interpreter state until the process ends."""
        thread = threading.get_ident()
        if thread not in self._kept:
            self._kept.add(thread)
            ctypes.pythonapi.PyGILState_Ensure()  # one more than will be released
