"""The live shell of a tap: a component that gets the whole bus instead of ports."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable
from typing import Any

from runtime.clock import SECOND_NS, FrameClock, LogTimes, PacedClock
from runtime.contract import Output
from runtime.door import FAILURE
from runtime.inbox import Arrival
from runtime.live import HOLD_KEY
from runtime.outlet import Outlet
from runtime.station import Station
from runtime.system import System, ports_of
from schemas.session_pb2 import Hold, Journal, Status

_QUEUE = 4096
"""Samples that wait; at 3000 a second and 10 kB now and then this is a second and 5 MB."""
_TICK_NS = SECOND_NS // 10
_BUSY_NS = 20_000_000
"""A bus that never falls silent must not keep the tap from its ticks: a recorder flushes by them."""
_FAREWELL_S = 0.4
"""How long the last messages of the others are waited for after the stop."""
LEAVE_OUT = "leave_out"
"""A tap's parameter: keys that it does not ask for. What nobody on the other host asks for does not cross the link."""
_SLICE_S = 0.005
"""A tap looks into its inbox this often. Waking it for each message would cost a third more of its time (measured)."""


class Tap:
    """Runs one tap until it is asked to stop and the others have said their last word."""

    def __init__(self, station: Station, tap: Any) -> None:
        """Subscribe to everything in the realm.

        Args:
            station: connected, not joined yet.
            tap: an instance with `message`, `tick` and `close`.
        """
        self._station = station
        self._tap = tap
        self._handled = 0
        self._tick_due_ns = 0
        self._status_due_ns = 0
        system = station.system
        self._lockstep = system.clock == "lockstep"
        self._frames = FrameClock()
        self._log_times = LogTimes()
        self._clock = PacedClock(station.assignment.origin_ns, system.pace or 1.0)
        box = station.inbox.box("bus", _QUEUE)
        left_out = frozenset(station.spec.params.get(LEAVE_OUT, ()))
        others = [row for row in known_keys(system) if row[2] != station.spec.name and row[0] not in left_out]
        for key, schema, publisher in others:
            station.lane(box, key, schema, publisher)
        for key in [key for key, _, _ in others] if left_out else ["**"]:
            station.subscribe(key)

    def run(self) -> None:
        """Pass the barrier, hand over messages until asked to stop, then wait for those still under way."""
        try:
            self._station.join()
            if self._lockstep:
                self._station.inbox.hold_back()
            while not self._station.stop.asked:
                self._turn()
            self._hear_out()
        finally:
            self._say_goodbye()

    def _say_goodbye(self) -> None:
        try:
            self._publish_status()
            for output in self._tap.close():
                self._station.outlets.ports[output.port].put(output.message, self._frames.now_ns)
        finally:
            self._station.close()

    def _hear_out(self) -> None:
        """Take what the others said until they left: a link delivers it before it tells of their leaving."""
        deadline_ns = time.monotonic_ns() + round(_FAREWELL_S * SECOND_NS)
        while not self._station.presence.is_alone(self._station.spec.name) and time.monotonic_ns() < deadline_ns:
            entry = self._station.inbox.take(_SLICE_S)
            if entry is not None:
                self._take(entry)
        while (entry := self._station.inbox.take(0)) is not None:
            self._take(entry)

    def _turn(self) -> None:
        now_ns = time.monotonic_ns()
        if now_ns >= self._tick_due_ns:
            self._tick_due_ns = now_ns + _TICK_NS
            self._publish(self._tap.tick(self._now_ns()), self._frames.now_ns)
        if now_ns >= self._status_due_ns:
            self._status_due_ns = now_ns + SECOND_NS
            self._publish_status()
        until_ns = now_ns + _BUSY_NS
        while time.monotonic_ns() < until_ns and (entry := self._station.inbox.take(0)) is not None:
            self._take(entry)
            if self._station.stop.asked:
                return
        time.sleep(_SLICE_S)

    def _now_ns(self) -> int:
        if self._lockstep:
            return self._frames.now_ns
        return self._frames.advance(self._clock.session_ns(time.monotonic_ns()))

    def _take(self, entry: Any) -> None:
        if isinstance(entry, Arrival):
            run, sequence, capture_ns = entry.stamp
            self._frames.advance(capture_ns if self._lockstep else self._now_ns())
            self._message(entry.key, entry.schema, entry.payload, run, sequence, capture_ns)
        elif entry.port == FAILURE:
            raise entry.message

    def _message(self, key: str, schema: str, payload: bytes, run: int, sequence: int, capture_ns: int) -> None:
        self._handled += 1
        log_ns = self._log_ns(key, run, capture_ns)
        self._publish(self._tap.message(key, schema, payload, run, sequence, capture_ns, log_ns), capture_ns)

    def _log_ns(self, key: str, run: int, capture_ns: int) -> int:
        return self._log_times.log_ns(key, run, capture_ns) if self._lockstep else self._frames.now_ns

    def _publish(self, outputs: Iterable[Output], capture_ns: int) -> None:
        for output in outputs:
            stamp_ns = capture_ns if output.capture_ns is None else output.capture_ns
            self._put(self._station.outlets.ports[output.port], output.message, stamp_ns)

    def _publish_status(self) -> None:
        self._put(self._station.outlets.status, self._station.status(self._handled), self._frames.now_ns)

    def _put(self, outlet: Outlet, message: Any, capture_ns: int) -> None:
        """Publish, and hand it over as well: what a tap says does not come back to it from the bus."""
        sequence, schema = outlet.sequence, message.DESCRIPTOR.full_name
        payload = outlet.put(message, capture_ns)
        log_ns = self._log_ns(outlet.key, self._station.run, capture_ns)
        self._tap.message(outlet.key, schema, payload, self._station.run, sequence, capture_ns, log_ns)


def known_keys(system: System) -> list[tuple[str, type[Any], str]]:
    """(key below the realm, schema, publisher) of everything that a system puts on the bus."""
    known: list[tuple[str, type[Any], str]] = [(HOLD_KEY, Hold, "supervisor")]
    for spec in system.components:
        outputs = ports_of(spec.run).OUTPUTS
        known += [(key, outputs[port].schema, spec.name) for port, key in spec.outputs.items()]
        known += [(f"{spec.name}/status", Status, spec.name), (f"{spec.name}/journal", Journal, spec.name)]
    return known + _from_elsewhere(system, {key for key, _, _ in known})


def _from_elsewhere(system: System, known: Collection[str]) -> list[tuple[str, type[Any], str]]:
    """What components of this system read that none of them publishes: another host's, or played from a log."""
    found: dict[str, type[Any]] = {}
    for spec in system.components:
        inputs = ports_of(spec.run).INPUTS
        found |= {key: inputs[port].schema for port, key in spec.inputs.items() if key not in known}
    return [(key, schema, "") for key, schema in found.items()]
