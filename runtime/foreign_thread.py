"""Zenoh's threads call into Python without being Python's: their interpreter state is made once, not per call.

CPython makes a thread state at each such call, maps memory for its stack and unmaps it afterwards: a flush of the
processor's address cache per message (seen with `perf`).
"""

from __future__ import annotations

import ctypes
import threading

_local = threading.local()


def keep_thread_state() -> None:
    """Keep the calling thread's interpreter state until the process ends. Cheap when repeated."""
    if not hasattr(_local, "kept"):
        _local.kept = True
        ctypes.pythonapi.PyGILState_Ensure()  # one more than will be released
