"""A source of images, watched by a thread of its own: it may hang, end, go away and come back."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from typing import NamedTuple, Protocol

from components.camera.header import PictureError
from components.camera.pace import Pace
from runtime.contract import DeviceError, Late
from schemas.image_pb2 import CompressedImage

BYTES_MAX = 4_000_000
"""Larger images are left out: nobody would read them."""
_REOPEN_S, _REOPEN_MAX_S = 0.25, 4.0
"""A source that was lost is opened again after the first, then after twice as long each time, up to the second."""
_SILENT_S = 2.0
"""Silence of so long is told once."""
_LOOK_S = 0.1
"""A thread that waits looks so often whether it shall end."""
_END_S = 1.5
"""A thread that hangs in its source is left behind after this, when the process ends."""


class Source(Protocol):
    """Something that has frames, used by one thread."""

    waits: bool
    """Whether each frame waits until the one before was read: a file does, the world does not."""

    def grab(self) -> int:
        """Wait for the next frame.

        Returns:
            Its monotonic time, ns; a frame of the future is held back until then.

        Raises:
            DeviceError: it is gone.
            EndError: there are no more.
        """
        ...

    def picture(self) -> bytes:
        """The grabbed frame as a JPEG. Raises PictureError, DeviceError."""
        ...

    def close(self) -> None:
        """Let go of it; never raises."""
        ...


class EndError(Exception):
    """A source has come to its end."""


class _Frame(NamedTuple):
    data: bytes
    time_ns: int


class Watched:
    """A device that says the newest frame of a source, and opens the source again when it is lost."""

    def __init__(self, name: str, hz: float, open_source: Callable[[], Source]) -> None:
        """Open it.

        Args:
            name: for messages.
            hz: frames a second that are passed on.
            open_source: makes the source; raises DeviceError.

        Raises:
            DeviceError: it can not be opened.
        """
        self._name = name
        self._open = open_source
        self._pace = Pace(hz)
        self._frame: _Frame | None = None
        self._changed = threading.Condition()
        self._done = threading.Event()
        self._failure: BaseException | None = None
        self._reopen_s = _REOPEN_S
        self._heard_s = time.monotonic()
        self._is_silent = False
        self._words = ""
        self._thread = threading.Thread(target=self._run, daemon=True, name="source")
        try:
            self._source: Source | None = open_source()
        except DeviceError as error:
            raise DeviceError(f"{name} {error}") from None

    def read(self, timeout_s: float) -> Late | None:
        """The newest frame, once, with its age."""
        if self._thread.ident is None:
            self._heard_s = time.monotonic()
            self._thread.start()
        with self._changed:
            self._changed.wait_for(lambda: self._frame or self._failure, timeout_s)
            frame, self._frame = self._frame, None
            self._changed.notify()
        if self._failure is not None:
            raise self._failure
        if frame is None:
            self._tell_silence()
            return None
        age_s = max(0.0, (time.monotonic_ns() - frame.time_ns) * 1e-9)
        return Late(CompressedImage(frame_id="camera", format="jpeg", data=frame.data), age_s)

    def write(self, message: object) -> None:
        """Nothing is told to a camera."""

    def close(self) -> None:
        """End the thread, and let go of the source unless the thread hangs in it."""
        self._done.set()
        if self._thread.ident is not None:
            self._thread.join(_END_S)
        elif self._source is not None:
            self._source.close()

    def _run(self) -> None:
        try:
            while not self._done.is_set():
                self._step()
        except BaseException as failure:  # noqa: BLE001  (the reader's thread raises it)
            with self._changed:
                self._failure = failure
                self._changed.notify()
        finally:
            if self._source is not None:
                self._source.close()

    def _step(self) -> None:
        try:
            if self._source is None:
                self._source = self._open()
                self._say("is open again")
            self._take(self._source)
        except PictureError as error:
            self._say(f"an image was left out: {error}")
        except EndError:
            self._say("has ended")
            self._done.wait()
        except DeviceError as error:
            self._lose(error)

    def _take(self, source: Source) -> None:
        while source.waits and self._frame is not None and not self._done.is_set():
            with self._changed:
                self._changed.wait_for(lambda: self._frame is None, _LOOK_S)
        time_ns = source.grab()
        self._reopen_s = _REOPEN_S
        if not self._pace.takes(time_ns):
            return
        data = source.picture()
        if len(data) > BYTES_MAX:
            raise PictureError(f"it has {len(data)} bytes; at most {BYTES_MAX} are passed on")
        self._done.wait(max(0.0, (time_ns - time.monotonic_ns()) * 1e-9))
        with self._changed:
            self._frame = _Frame(data, time_ns)
            self._heard_s, self._is_silent = time.monotonic(), False
            self._changed.notify()

    def _lose(self, error: DeviceError) -> None:
        self._say(f"{error}; opening it again and again")
        if self._source is not None:
            self._source.close()
            self._source = None
        self._done.wait(self._reopen_s)
        self._reopen_s = min(2.0 * self._reopen_s, _REOPEN_MAX_S)

    def _tell_silence(self) -> None:
        if not self._is_silent and time.monotonic() - self._heard_s > _SILENT_S:
            self._is_silent = True
            self._say(f"has shown nothing for {_SILENT_S:.0f} s")

    def _say(self, words: str) -> None:
        """Once, however often it happens; standard output is the component's log."""
        if words != self._words:
            self._words = words
            sys.stdout.write(f"camera {self._name}: {words}\n")
            sys.stdout.flush()
