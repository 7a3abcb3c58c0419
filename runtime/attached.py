"""An opened device in its component's process: read on a thread of its own, closed whatever happens."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from runtime.contract import Device, Late
from runtime.inbox import Arrival, Box
from runtime.outlet import Outlet
from runtime.wire import Stamp

_READ_S = 0.05
"""A reader looks whether it shall end this often."""


class Attached:
    """A device with its reader's thread.

    A reading goes into the component's inbox, where the port's policy bounds it, and then onto the bus.
    """

    def __init__(
        self,
        device: Device,
        box: Box | None,
        outlet: Outlet | None,
        deliver: Callable[[Arrival], None],
        failed: Callable[[BaseException], None],
    ) -> None:
        """Nothing is read before `start`.

        Args:
            device: opened.
            box: of the input `device`; None = the component does not want to hear it (a camera).
            outlet: of the output `device`; None = the device reads nothing.
            deliver: takes a reading for the component, on the reader's thread.
            failed: takes what reading raised, on the reader's thread.
        """
        self._device = device
        self._box = box
        self._outlet = outlet
        self._deliver = deliver
        self._failed = failed
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True, name="device")

    def start(self, session_ns: Callable[[int], int]) -> None:
        """Begin to read.

        Args:
            session_ns: session time at a monotonic time.
        """
        self._session_ns = session_ns
        self._thread.start()

    def write(self, message: Any) -> None:
        """Carry out a command that the component has said on `actuate`."""
        self._device.write(message)

    def close(self) -> None:
        """End the thread and close the device."""
        self._done.set()
        if self._thread.ident is not None:
            self._thread.join(4 * _READ_S)
        self._device.close()

    def _run(self) -> None:
        try:
            while not self._done.is_set():
                reading = self._device.read(_READ_S)
                if reading is not None and not self._done.is_set():
                    message, age_s = reading if isinstance(reading, Late) else (reading, 0.0)
                    self._say(message, self._session_ns(time.monotonic_ns() - round(age_s * 1e9)))
        except BaseException as failure:  # noqa: BLE001  (the main thread raises it)
            if not self._done.is_set():
                self._failed(failure)

    def _say(self, message: Any, capture_ns: int) -> None:
        outlet = self._outlet
        if outlet is None:
            return
        stamp = Stamp(outlet.run, outlet.sequence, capture_ns)
        payload = message.SerializeToString(deterministic=True)
        if self._box is not None:
            schema = message.DESCRIPTOR.full_name
            self._deliver(Arrival(self._box, outlet.key, schema, payload, stamp))
        outlet.send(payload, stamp.sequence, capture_ns)
