"""A whole system in one process under a virtual clock: deterministic, as fast as the processor allows.

Total order of messages: (time, order of publication); a message published at t is handled at t by its readers in
launch order, except that the world's next frame is published at its own later capture time. Every message passes
through its bytes, as on the bus.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterable
from typing import Any, Protocol

from runtime.clock import TickSchedule
from runtime.contract import GONE, STALL, STOP, TICK, ComponentError, Event, Stall, Tick
from runtime.hosted import Hosted, Sample
from runtime.journal import JournalWriter
from runtime.messages import message_class
from runtime.system import System


class Tap(Protocol):
    """Gets the whole bus (`components.recorder`)."""

    def message(  # noqa: D102
        self, key: str, schema: str, payload: bytes, run: int, sequence: int, capture_ns: int, time_ns: int
    ) -> tuple[Any, ...]: ...
    def tick(self, time_ns: int) -> tuple[Any, ...]: ...  # noqa: D102
    def close(self) -> tuple[Any, ...]: ...  # noqa: D102


class Lockstep:
    """Runs a system until its end message, its duration, or somebody's `stop`."""

    def __init__(self, system: System, *, taps: Iterable[Tap] = (), runs: int = 1) -> None:
        """Make every component that is not a tap.

        Args:
            system: the resolved launch file; its clock must be lockstep.
            taps: get every message.
            runs: run id of the first component; the others count on (virtual time needs no random ids).
        """
        self.time_ns = 0
        self.end_reason = ""
        self.messages = 0
        self.observe: Callable[[str, Event, list[Sample]], None] | None = None
        """Called with a component's name, each event handed to it, and what it said."""
        self._taps = tuple(taps)
        self._heap: list[tuple[int, int, Sample]] = []
        self._count = 0
        self._watched: dict[str, Callable[[Any, int], object]] = {}
        specs = [spec for spec in system.components if not spec.tap]
        self._hosted = [Hosted(spec, runs + index, system.file) for index, spec in enumerate(specs)]
        self._ticks = {
            hosted.spec.name: TickSchedule(port.hz)
            for hosted in self._hosted
            for port in hosted.inputs.values()
            if isinstance(port, Tick)
        }
        self._journals = {hosted.spec.name: JournalWriter() for hosted in self._hosted}
        self._readers: dict[str, list[tuple[Hosted, str]]] = {}
        for hosted in self._hosted:
            for port, key in hosted.spec.inputs.items():
                self._readers.setdefault(key, []).append((hosted, port))
        if system.end:
            self.watch(system.end, self._end)

    def watch(self, key: str, call: Callable[[Any, int], object]) -> None:
        """Call with every decoded message of a key and its capture time."""
        self._watched[key] = call

    def stop(self, reason: str) -> None:
        """End after the message that is being handled."""
        self.end_reason = self.end_reason or reason

    def _end(self, message: Any, _capture_ns: int) -> None:
        self.stop(message.reason)

    def run(self, duration_s: float | None = None) -> str:
        """Run to the end and return its reason.

        Raises:
            ComponentError: a component can not go on.
        """
        limit_ns = None if duration_s is None else round(duration_s * 1e9)
        for hosted in self._hosted:
            if hosted.spec.name in self._ticks:
                self._tick(hosted)
        while not self.end_reason:
            if not self._heap:
                self._stall()
                continue
            if limit_ns is not None and self._heap[0][0] > limit_ns:
                self.stop("duration")
                break
            time_ns, _, sample = heapq.heappop(self._heap)
            self.time_ns = max(self.time_ns, time_ns)
            self._deliver(sample)
        self._finish()
        return self.end_reason

    def _deliver(self, sample: Sample) -> None:
        self.messages += 1
        for tap in self._taps:
            self._tap(tap, sample)
        if sample.key in self._watched:
            self._watch(sample)
        for hosted, port in self._readers.get(sample.key, ()):
            self._tick(hosted)
            message = hosted.decode(port, sample.payload)
            self._hand(hosted, Event(self.time_ns, port, message, sample.capture_ns, sample.run, sample.sequence))

    def _tap(self, tap: Tap, sample: Sample) -> None:
        tap.message(*sample, time_ns=self.time_ns)

    def _watch(self, sample: Sample) -> None:
        kind = message_class(sample.schema)
        if kind is not None:
            self._watched[sample.key](kind.FromString(sample.payload), sample.capture_ns)

    def _tick(self, hosted: Hosted) -> None:
        schedule = self._ticks.get(hosted.spec.name)
        if schedule is not None and schedule.due(self.time_ns) is not None:
            self._hand(hosted, Event(self.time_ns, TICK, capture_ns=self.time_ns))

    def _stall(self) -> None:
        """Nothing is on its way: somebody owes an answer."""
        worlds = [hosted for hosted in self._hosted if any(isinstance(p, Stall) for p in hosted.inputs.values())]
        if not worlds:
            raise ComponentError(f"lockstep stands still at {self.time_ns / 1e9:.3f} s: nobody answers")
        for hosted in worlds:
            self._hand(hosted, Event(self.time_ns, STALL, capture_ns=self.time_ns))

    def _hand(self, hosted: Hosted, event: Event) -> None:
        journal = self._journals[hosted.spec.name]
        name = f"{GONE}:{event.message}" if event.port == GONE else event.port
        journal.add(name, event.source_run, event.sequence, event.time_ns, 0)
        samples = hosted.handle(event)
        if self.observe is not None:
            self.observe(hosted.spec.name, event, samples)
        for sample in samples:
            self._publish(sample)
        if journal.is_due(0):  # virtual time needs no deadline, only a size
            self._publish_journal(hosted)

    def _publish(self, sample: Sample) -> None:
        heapq.heappush(self._heap, (max(self.time_ns, sample.capture_ns), self._count, sample))
        self._count += 1

    def _publish_journal(self, hosted: Hosted) -> None:
        batch = self._journals[hosted.spec.name].take()
        if batch is not None:
            self._publish(hosted.journal(batch, self.time_ns))

    def _finish(self) -> None:
        """Hand everyone the last event; what is still under way and what they still say is recorded, read by nobody."""
        self._readers.clear()
        for hosted in self._hosted:
            self._hand(hosted, Event(self.time_ns, STOP, capture_ns=self.time_ns))
            self._publish_journal(hosted)
        while self._heap:
            self._deliver(heapq.heappop(self._heap)[2])
        for tap in self._taps:
            tap.close()
