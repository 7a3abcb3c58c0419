"""Plays a recording to a viewer that has the controls and no time line of its own."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from threading import Event
from typing import NamedTuple

from runtime.clock import LOG_SKEW_NS, SECOND_NS
from runtime.playhead import Playhead
from runtime.playlist import in_order
from runtime.recording import Recording
from viewer.live import Sink
from viewer.scene import Scene
from viewer.shown import Shown

_TELL_NS = SECOND_NS // 10
_SLICE_S = 0.05
_RATES = (0.01, 100.0)


class _Asked(NamedTuple):
    plays: bool
    rate: float
    sought_ns: int | None


class Reel:
    """A recording on its way past the viewer. Paused at the beginning."""

    def __init__(self, load: Callable[[], tuple[Recording, Scene]], sink: Sink) -> None:
        """Load nothing yet.

        Args:
            load: gives the recording and a scene that has seen nothing.
            sink: the viewer.
        """
        self._load = load
        self._sink = sink
        self._head = Playhead(1.0, paused=True)
        self._asked: deque[_Asked] = deque(maxlen=64)
        self._bell = Event()
        self._sought_ns: int | None = None
        self._told_ns = 0
        self.has_ended = False

    @property
    def plays(self) -> bool:
        """Whether time goes on."""
        return not (self._head.paused or self.has_ended)

    @property
    def rate(self) -> float:
        """Session seconds a second."""
        return self._head.rate

    @property
    def time_ns(self) -> int:
        """Session time shown."""
        return self._head.time_ns

    def ask(self, *, plays: bool, rate: float, sought_ns: int | None) -> None:
        """Play or pause, how fast, and from where; from any thread."""
        low, high = _RATES
        self._asked.append(_Asked(plays, min(max(rate, low), high), sought_ns))
        self._bell.set()

    def run(self, is_over: Callable[[], bool], tell: Callable[[Reel], None]) -> None:
        """Obey until it is over; `tell` is called ten times a second."""
        since_ns = 0
        while not is_over():
            self._play(since_ns, is_over, tell)
            while self._sought_ns is None and not is_over():
                self._obey(tell)
                self._sink.flush()
            since_ns, self._sought_ns = self._sought_ns or 0, None

    def _play(self, since_ns: int, is_over: Callable[[], bool], tell: Callable[[Reel], None]) -> None:
        """From a moment to the end, or to the next leap."""
        recording, scene = self._load()
        self.has_ended = False
        self._head.seek(since_ns)
        self._sink.stands(scene.furniture())
        before: dict[str, Shown] | None = {}
        for logged in in_order(recording.messages(), LOG_SKEW_NS, lambda each: each.time_ns):
            shown = scene.take(logged, logged.capture_ns)
            if logged.time_ns < since_ns and before is not None:
                before |= {each.entity: each for each in shown}
                continue
            if before is not None:
                self._sink.show(before.values())
                before = None
            if not self._await(logged.time_ns, is_over, tell):
                return
            self._sink.show(shown)
            self._head.passed(logged.time_ns)
        self.has_ended = True

    def _await(self, time_ns: int, is_over: Callable[[], bool], tell: Callable[[Reel], None]) -> bool:
        """Wait until a message is due; False if something else is to be done."""
        while True:
            if self._sought_ns is not None or is_over():
                return False
            wait_ns = self._head.wait_ns(time_ns, time.monotonic_ns())
            if wait_ns == 0 and not self._asked:
                return True
            self._sink.flush()
            self._obey(tell, _SLICE_S if wait_ns is None else min(wait_ns / SECOND_NS, _SLICE_S))

    def _obey(self, tell: Callable[[Reel], None], wait_s: float = _SLICE_S) -> None:
        if not self._asked:
            self._bell.wait(wait_s)
            self._bell.clear()
        while self._asked:
            asked = self._asked.popleft()
            if asked.plays == self._head.paused:
                self._head.toggle()
            if asked.rate != self._head.rate:
                self._head.rate = asked.rate
                self._head.seek(self._head.time_ns)
            self._sought_ns = asked.sought_ns if asked.sought_ns is not None else self._sought_ns
        now_ns = time.monotonic_ns()
        if now_ns > self._told_ns + _TELL_NS:
            self._told_ns = now_ns
            tell(self)
