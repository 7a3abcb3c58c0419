"""The live shell of a fold: one process, one thread that calls `handle`, events from the bus."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from threading import Lock
from typing import Any

from runtime.attached import Attached
from runtime.capture_order import CaptureOrder
from runtime.clock import SECOND_NS, FrameClock, PacedClock, Pacer, TickSchedule
from runtime.contract import ACTUATE, DEVICE, GONE, STALL, STOP, TICK, Device, Event, Port, Stall, Tick
from runtime.door import FAILURE
from runtime.hosted import Hosted
from runtime.inbox import Arrival, Notice
from runtime.journal import LOADED, JournalWriter
from runtime.station import Station
from runtime.wire import Decoder, Refused
from runtime.wiring import publishers
from schemas.session_pb2 import Hold

HOLD_KEY = "supervisor/hold"
_SNAPSHOT = "berth.Snapshot"
_FUTURE_NS = SECOND_NS
"""Real time: a capture time further ahead than this is a lie."""
_IDLE_NS = SECOND_NS // 20
_PATIENT_NS = 5_000_000
"""Off the control path the inbox is looked into this often; a wake-up per message costs more than the message."""
_SLICE_NS = 20_000_000
"""A paced frame waits in slices, so that a signal is seen between two."""


class Fold:
    """Runs one component until it is asked to stop."""

    def __init__(self, station: Station, hosted: Hosted, device: Device | None = None) -> None:
        """Subscribe to the component's wired inputs.

        Args:
            station: connected, not joined yet.
            hosted: the component.
            device: opened; closed at the end of `run`.
        """
        self._station = station
        self._hosted = hosted
        self._inbox = station.inbox
        self._outlets = {outlet.key: outlet for outlet in station.outlets.ports.values()}
        self._journal = JournalWriter()
        self._order = CaptureOrder()
        self._status_due_ns = 0
        self._heard_ns = 0
        self._holders: set[int] = set()
        """Runs of the supervisors that hold time: they restart a component, or somebody has asked them to."""
        self._aside: deque[Arrival] = deque()
        """What came meanwhile; at most one answer per input and frame."""
        self._foreign: set[str] = set()
        """Input ports that another host publishes; its clock is not ours."""
        system = station.system
        self._lockstep = system.clock == "lockstep"
        self._frames = FrameClock()
        self._clock = PacedClock(station.assignment.origin_ns, system.pace or 1.0)
        self._pacer = Pacer(system.pace) if self._lockstep and system.pace else None
        tick = hosted.inputs.get(TICK)
        self._ticks = TickSchedule(tick.hz) if isinstance(tick, Tick) else None
        stalls = self._lockstep and isinstance(hosted.inputs.get(STALL), Stall)
        self._stall_ns = round(system.stall_s * SECOND_NS) if stalls else None
        self._patient = not is_on_control_path(hosted.outputs)
        self._turn = Lock()
        """Held by the one thread that calls `handle`."""
        self._open = False
        """Whether samples may be handed over: between the start barrier and the stop."""
        self._failure: BaseException | None = None
        if not self._patient:
            station.door.serve = self._serve_at_once
        self._decoders = self._subscribe()
        self._device = None if device is None else self._attached(device)

    def _attached(self, device: Device) -> Attached:
        box = next((box for box in self._inbox.boxes if box.name == DEVICE), None)
        return Attached(device, box, self._station.outlets.ports.get(DEVICE), self._deliver, self._station.failed)

    def _deliver(self, reading: Arrival) -> None:
        """On the device's thread: as if zenoh had brought it."""
        self._inbox.put(reading)
        if self._station.door.serve is not None:
            self._station.door.serve()

    def _subscribe(self) -> dict[str, Decoder]:
        sources = publishers(self._station.system)
        decoders = {}
        for name, key in self._station.spec.inputs.items():
            port: Port = self._hosted.inputs[name]
            box = self._inbox.box(name, port.queue, latest=port.queue == 1)
            if self._lockstep and port.per_frame:
                box.latest, box.limit = False, max(port.queue, 16)
            publisher = sources.get(key, ("", ""))[0]
            self._station.lane(box, key, port.schema, publisher)
            if not self._station.system.is_here(publisher):
                self._foreign.add(name)
            self._station.subscribe(key)
            decoders[name] = Decoder(port.schema)
        if self._stall_ns is not None:
            self._station.lane(self._inbox.box(HOLD_KEY, 16), HOLD_KEY, Hold, "supervisor")
            self._station.subscribe(HOLD_KEY)
            decoders[HOLD_KEY] = Decoder(Hold)
        return decoders

    def run(self) -> None:
        """Pass the barrier, handle events until asked to stop, hand over the last one, say goodbye."""
        try:
            self._station.join()
            self._heard_ns = time.monotonic_ns()
            if self._lockstep:
                self._inbox.hold_back()
            with self._turn:
                self._resume()
                if self._ticks is not None and self._lockstep and not self._station.stop.asked:
                    self._tick_up_to(0)
            self._open = True
            if self._device is not None and not self._station.stop.asked:
                self._device.start(self._clock.session_ns)
            while not self._station.stop.asked:
                self._attend()
            with self._turn:
                self._hand(self._own_event(STOP, self._now_ns()))
        finally:
            self._open = False
            if self._device is not None:
                self._device.close()
            self._flush_journal()
            self._publish_status()
            self._station.close()

    def _resume(self) -> None:
        """Go on from the snapshot that the supervisor has kept, if there is one; without it, start cold."""
        kept = self._station.assignment.snapshot
        if kept is None:
            return
        try:
            self._hosted.load(Path(kept.file).read_bytes())
        except (OSError, ValueError) as reason:
            print(f"starts cold, its snapshot can not be loaded: {reason}", flush=True)  # noqa: T201
            return
        self._journal.add(LOADED, kept.run, kept.sequence, self._now_ns(), time.monotonic_ns())

    def _attend(self) -> None:
        """One round of the main thread: duties of time, then whatever waits, then a rest."""
        with self._turn:
            self._do_duties(time.monotonic_ns())
        self._serve()
        if self._failure is not None:
            raise self._failure
        now_ns = time.monotonic_ns()
        self._inbox.wait(max(0, self._next_duty_ns(now_ns) - now_ns) / SECOND_NS)

    def _do_duties(self, now_ns: int) -> None:
        if not self._lockstep and self._ticks is not None:
            self._tick_up_to(self._clock.session_ns(now_ns))
        if self._journal.is_due(now_ns):
            self._flush_journal()
        if now_ns >= self._status_due_ns:
            self._publish_status()
            self._status_due_ns = now_ns + SECOND_NS
        self._check_stall(now_ns)

    def _serve_at_once(self) -> None:
        """On zenoh's thread: hand over what it has just brought."""
        try:
            self._serve()
        except BaseException as failure:  # noqa: BLE001  (zenoh would swallow it; the main thread raises it)
            self._failure = failure
            self._inbox.notify(Notice("wake"))

    def _serve(self) -> None:
        """Hand over what waits, unless another thread is at it: that one looks again after letting go."""
        while self._may_serve() and self._turn.acquire(blocking=False):
            try:
                while self._may_serve() and (entry := self._inbox.take(0)) is not None:
                    self._dispatch(entry)
                if self._journal.is_due(time.monotonic_ns()):
                    self._flush_journal()
            finally:
                self._turn.release()

    def _may_serve(self) -> bool:
        halted = self._failure is not None or self._station.stop.asked or not self._open
        return not (halted or self._inbox.is_empty)

    def _dispatch(self, entry: Arrival | Notice) -> None:
        if not isinstance(entry, Arrival):
            self._notice(entry)
        elif self._holders and entry.box.name != HOLD_KEY:
            self._aside.append(entry)  # time stands still, and the world with it
        else:
            self._receive(entry)

    def _next_duty_ns(self, now_ns: int) -> int:
        """Monotonic time at which something must be done though nothing is received."""
        duty_ns = min(now_ns + (_PATIENT_NS if self._patient else _IDLE_NS), self._status_due_ns)
        journal_ns = self._journal.due_ns()
        if journal_ns is not None:
            duty_ns = min(duty_ns, journal_ns)
        if not self._lockstep and self._ticks is not None:
            duty_ns = min(duty_ns, self._clock.monotonic_ns(self._ticks.next_ns))
        if self._stall_ns is not None:
            duty_ns = min(duty_ns, self._heard_ns + self._stall_ns)
        return duty_ns

    def _now_ns(self) -> int:
        if self._lockstep:
            return self._frames.now_ns
        return self._frames.advance(self._clock.session_ns(time.monotonic_ns()))

    def _receive(self, sample: Arrival) -> None:
        port, stamp = sample.box.name, sample.stamp
        try:
            self._check_capture(port, stamp.capture_ns)
            message = self._decoders[port](sample.payload)
            if port != HOLD_KEY:  # it has no capture time
                self._order.check(port, stamp)
        except Refused as reason:
            self._station.door.refusals.add(sample.key, reason)
            return
        if port == HOLD_KEY:
            self._hold(message, stamp.run)
            return
        self._heard_ns = time.monotonic_ns()
        if self._lockstep and self._ticks is not None:
            self._tick_up_to(max(stamp.capture_ns, self._frames.now_ns))
        # Another host's clock does not move this one's; in lockstep there is only one.
        least_ns = 0 if port in self._foreign and not self._lockstep else stamp.capture_ns
        time_ns = self._frames.advance(max(least_ns, self._now_ns()))
        self._hand(Event(time_ns, port, message, *_cause(stamp)))

    def _check_capture(self, port: str, capture_ns: int) -> None:
        """Off the control path another host's time is taken as it is, and never compared with our own.

        On the control path what comes from another host answers a frame of this one, so it can not be newer than now.
        """
        foreign = port in self._foreign
        if self._lockstep or (foreign and self._patient):
            return
        if capture_ns > self._clock.session_ns(time.monotonic_ns()) + (0 if foreign else _FUTURE_NS):
            raise Refused(f"capture time {capture_ns} ns lies in the future")

    def _notice(self, notice: Notice) -> None:
        if notice.port == FAILURE:
            raise notice.message
        if notice.port == GONE and GONE in self._hosted.inputs:
            name, run = notice.message
            self._hand(self._own_event(GONE, self._now_ns(), name, run))

    def _hold(self, hold: Hold, run: int) -> None:
        (self._holders.add if hold.active else self._holders.discard)(run)
        self._heard_ns = time.monotonic_ns()
        while self._aside and not self._holders:
            self._receive(self._aside.popleft())

    def _check_stall(self, now_ns: int) -> None:
        if self._stall_ns is None or now_ns < self._heard_ns + self._stall_ns:
            return
        self._heard_ns = now_ns
        if not self._holders:
            late, newest_ns = self._order.late()
            self._station.note = f"stall: nothing on {late or 'any input'} since {newest_ns / 1e9:.3f} s"
            print(self._station.note, flush=True)  # noqa: T201  (standard output is the component's log)
            self._hand(self._own_event(STALL, self._now_ns()))

    def _tick_up_to(self, time_ns: int) -> None:
        due_ns = self._ticks.due(time_ns) if self._ticks is not None else None
        if due_ns is not None:
            self._hand(self._own_event(TICK, self._frames.advance(time_ns)))

    @staticmethod
    def _own_event(port: str, time_ns: int, message: Any = None, run: int = 0) -> Event:
        """An event that the shell makes; what it causes is as old as the event itself."""
        return Event(time_ns, port, message, time_ns, run)

    def _hand(self, event: Event) -> None:
        name = f"{GONE}:{event.message}" if event.port == GONE else event.port
        self._journal.add(name, event.source_run, event.sequence, event.time_ns, time.monotonic_ns())
        for sample in self._hosted.handle(event):
            if self._pacer is not None and sample.capture_ns > event.time_ns:
                self._wait(self._pacer.wait_ns(sample.capture_ns, time.monotonic_ns()))
            if sample.schema == _SNAPSHOT:
                self._flush_journal()  # whoever goes on from it can be replayed, though this process is killed now
            outlet = self._outlets[sample.key]
            if self._device is not None and outlet is self._station.outlets.ports.get(ACTUATE):
                self._device.write(outlet.schema.FromString(sample.payload))
            outlet.send(sample.payload, sample.sequence, sample.capture_ns)

    def _wait(self, wait_ns: int) -> None:
        """Keep the world's next frame back until its wall time."""
        until_ns = time.monotonic_ns() + wait_ns
        while not self._station.stop.asked:
            remaining_ns = until_ns - time.monotonic_ns()
            if remaining_ns <= 0:
                return
            time.sleep(min(remaining_ns, _SLICE_NS) / SECOND_NS)

    def _flush_journal(self) -> None:
        batch = self._journal.take()
        if batch is not None:
            self._station.outlets.journal.put(batch, self._frames.now_ns)

    def _publish_status(self) -> None:
        self._station.outlets.status.put(self._station.status(self._hosted.handled), self._frames.now_ns)


def is_on_control_path(outputs: Mapping[str, Port]) -> bool:
    """Whether a component must answer each frame; one that need not may lag behind a little."""
    return any(port.per_frame for port in outputs.values())


def _cause(stamp: Any) -> tuple[int, int, int]:
    return stamp.capture_ns, stamp.run, stamp.sequence
