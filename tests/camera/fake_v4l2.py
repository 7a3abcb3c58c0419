"""A camera for machines without one: a FIFO that a preloaded driver (fake_v4l2.c) shows to OpenCV as /dev/video0."""

import atexit
import contextlib
import functools
import os
import select
import shutil
import struct
import subprocess
import tempfile
import threading
import time
from pathlib import Path

SOURCE = Path(__file__).with_suffix(".c")


@functools.cache
def _built():
    """The driver, compiled."""
    library = Path(tempfile.mkdtemp(prefix="berth-fake-v4l2-")) / "fake_v4l2.so"
    atexit.register(shutil.rmtree, library.parent, ignore_errors=True)
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", str(SOURCE), "-o", str(library), "-ldl"], check=True)
    return library


def environment(path, **more):
    """With which a process has this camera at a path."""
    return {"LD_PRELOAD": str(_built()), "FAKE_V4L2": str(path), **more}


class Lens:
    """What the camera sees. Plugged in from the beginning; who unplugs it removes its file."""

    def __init__(self, path):
        self.path = Path(path)
        self._turn = threading.Lock()
        self.plug()

    def plug(self):
        os.mkfifo(self.path)
        # With a reader of its own it can be opened before the camera is.
        self._file = os.open(self.path, os.O_RDWR | os.O_NONBLOCK)
        self._is_in = True

    def unplug(self):
        self._is_in = False
        with self._turn:
            self.path.unlink()
            os.close(self._file)

    def show(self, data, time_ns=None):
        """One frame, unless it is unplugged; lost if the pipe is full because nobody looks."""
        time_us = (time.monotonic_ns() if time_ns is None else time_ns) // 1000
        waiting = memoryview(struct.pack("<IIQ", len(data), 0, time_us) + data)
        with self._turn, contextlib.suppress(BlockingIOError):
            if self._is_in:
                waiting = waiting[os.write(self._file, waiting[:16]) :]
            while waiting and self._is_in:
                if select.select([], [self._file], [], 0.05)[1]:
                    waiting = waiting[os.write(self._file, waiting) :]

    def close(self):
        if self._is_in:
            self.unplug()


class Shows:
    """Shows one picture after the other, so many a second, on a thread of its own."""

    def __init__(self, lens, picture, hz=30.0):
        self._lens, self._picture, self._hz = lens, picture, hz
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._show, daemon=True)
        self._thread.start()

    def _show(self):
        while not self._done.wait(1.0 / self._hz):
            self._lens.show(self._picture())

    def close(self):
        self._done.set()
        self._thread.join(10.0)
