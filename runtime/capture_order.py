"""Capture times of one run on one port: they may lag, and do not run backwards. Pure."""

from __future__ import annotations

from operator import itemgetter

from runtime.clock import LOG_SKEW_NS
from runtime.wire import Refused, Stamp


class CaptureOrder:
    """The newest capture time on each port.

    A component that answers late, or stops between two frames, says something older after something newer; never by
    more than a recorder waits for it.
    """

    def __init__(self) -> None:
        """Nothing was received."""
        self._newest: dict[str, Stamp] = {}

    def check(self, port: str, stamp: Stamp) -> None:
        """Note one message.

        Raises:
            Refused: its time lies before that of a message of the same run by more than `LOG_SKEW_NS`.
        """
        newest = self._newest.get(port, stamp)
        if newest.run != stamp.run or stamp.capture_ns >= newest.capture_ns:
            self._newest[port] = stamp
        elif stamp.capture_ns < newest.capture_ns - LOG_SKEW_NS:
            back_s = (newest.capture_ns - stamp.capture_ns) / 1e9
            raise Refused(f"time runs backwards by {back_s:.3f} s in run {stamp.run:016x}")

    def late(self) -> tuple[str, int]:
        """The port whose newest message is the oldest, and its capture time; no name before the first message."""
        newest = ((port, stamp.capture_ns) for port, stamp in self._newest.items())
        return min(newest, key=itemgetter(1), default=("", 0))
