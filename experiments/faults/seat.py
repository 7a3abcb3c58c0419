"""One component's place in a system without processes: its door, its inbox, its ticks."""

from __future__ import annotations

from runtime.capture_order import CaptureOrder
from runtime.clock import FrameClock, TickSchedule
from runtime.contract import GONE, STOP, TICK, Event, Peers, Port, Tick
from runtime.hosted import Hosted, Sample
from runtime.inbox import Arrival, Inbox, Notice
from runtime.sequence import Sequences
from runtime.system import ComponentSpec
from runtime.wire import Refused, Stamp


class Seat:
    """A fold as its live shell runs it: refuses what is said again, bounds what waits, lets late ticks coalesce."""

    def __init__(self, spec: ComponentSpec, run: int, file: str) -> None:
        self.hosted = Hosted(spec, run, file)
        self.asleep = self.dead = False
        self.refused = 0
        self._inbox = Inbox()
        self._boxes = {
            key: self._inbox.box(name, port.queue, latest=port.queue == 1)
            for name, key in spec.inputs.items()
            if isinstance(port := self.hosted.inputs[name], Port)
        }
        self._sequences = {key: Sequences() for key in self._boxes}
        self._order = CaptureOrder()
        self._time = FrameClock()
        tick = self.hosted.inputs.get(TICK)
        self._ticks = TickSchedule(tick.hz) if isinstance(tick, Tick) else None

    @property
    def period_ns(self) -> int:
        """Of its tick; 0 if it has none."""
        return 0 if self._ticks is None else self._ticks.period_ns

    def reads(self, key: str) -> bool:
        """Whether a key is wired to it."""
        return key in self._boxes

    def expect(self, run: int) -> None:
        """A run has been announced, which may have begun before."""
        for sequences in self._sequences.values():
            sequences.expect(run, None)

    def arrive(self, sample: Sample) -> None:
        """Leave a message in the inbox."""
        stamp = Stamp(sample.run, sample.sequence, sample.capture_ns)
        try:
            self._sequences[sample.key].receive(stamp.run, stamp.sequence)
        except Refused:
            self.refused += 1
            return
        self._inbox.put(Arrival(self._boxes[sample.key], sample.key, sample.schema, sample.payload, stamp))

    def lose(self, name: str) -> None:
        """A component has died."""
        if any(isinstance(port, Peers) for port in self.hosted.inputs.values()):
            self._inbox.notify(Notice(GONE, name))

    def serve(self, now_ns: int) -> list[Sample]:
        """Hand over what waits."""
        said: list[Sample] = []
        while not self._idle and (entry := self._inbox.take(0)) is not None:
            said += self._receive(entry, now_ns) if isinstance(entry, Arrival) else self._note(entry, now_ns)
        return said

    def tick(self, now_ns: int) -> list[Sample]:
        """Hand over the tick that is due, if one is."""
        if self._idle or self._ticks is None or self._ticks.due(now_ns) is None:
            return []
        return self._own(TICK, now_ns)

    def stop(self, now_ns: int) -> list[Sample]:
        """Hand over the last event."""
        said = [] if self._idle else self._own(STOP, now_ns)
        self.dead = True
        return said

    @property
    def _idle(self) -> bool:
        return self.asleep or self.dead

    def _receive(self, arrival: Arrival, now_ns: int) -> list[Sample]:
        stamp, port = arrival.stamp, arrival.box.name
        try:
            self._order.check(port, stamp)
        except Refused:
            self.refused += 1
            return []
        message = self.hosted.decode(port, arrival.payload)
        time_ns = self._time.advance(max(now_ns, stamp.capture_ns))
        return self.hosted.handle(Event(time_ns, port, message, stamp.capture_ns, stamp.run, stamp.sequence))

    def _note(self, notice: Notice, now_ns: int) -> list[Sample]:
        return self._own(notice.port, now_ns, notice.message)

    def _own(self, port: str, now_ns: int, message: object = None) -> list[Sample]:
        time_ns = self._time.advance(now_ns)
        return self.hosted.handle(Event(time_ns, port, message, time_ns))
