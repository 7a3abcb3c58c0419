"""One run of a component, once more: its journal says what it was handed, in which order and when."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from google.protobuf.message import DecodeError

from runtime.contract import GONE, STOP, Event, Port
from runtime.hosted import Hosted, Sample
from runtime.journal import LOADED, Entry, entries
from runtime.system import ComponentSpec
from runtime.window import Window
from schemas.session_pb2 import Journal


@dataclass
class Outcome:
    """How far a run could be replayed."""

    run: int
    events: int = 0
    until_ns: int = 0
    """Session time of the last event that was handed over, or of the first that could not be."""
    stopped: str = ""
    """Why the replay ends before the run did; empty if it does not."""
    ended: bool = False
    """The run's last event, its stop, was replayed."""
    raised: str = ""
    """What the component raised in the replay."""
    outputs: dict[str, int] = field(default_factory=dict)
    """Key -> messages said."""
    went_on: bool = False
    """It went on from a snapshot of a former run."""

    @property
    def words(self) -> str:
        """Until when the run was replayed, empty if to its end."""
        if self.stopped:
            return f"replayable until {self.until_ns / 1e9:.3f} s: {self.stopped}"
        return "" if self.ended or self.raised else f"the journal ends at {self.until_ns / 1e9:.3f} s, without a stop"


class Rerun:
    """Feeds a fresh component with what its journal names, as soon as both the entry and its message are there."""

    def __init__(
        self,
        spec: ComponentSpec,
        run: int,
        file: str,
        windows: Mapping[str, Window],
        snapshots: Mapping[tuple[int, int], bytes],
        tell: Callable[[Sample], None],
    ) -> None:
        """Make the component.

        Args:
            spec: of the component.
            run: run id in the session.
            file: for error messages.
            windows: input port -> messages received on it, filled by the caller.
            snapshots: (run id, sequence) -> payload, of what the replay of former runs has said.
            tell: called with each output.
        """
        self.outcome = Outcome(run)
        self._spec = spec
        self._hosted = Hosted(spec, run, file)
        self._windows = windows
        self._snapshots = snapshots
        self._tell = tell
        self._queue: deque[Entry] = deque()
        self._next = 0

    @property
    def is_over(self) -> bool:
        """Whether nothing more can be replayed."""
        outcome = self.outcome
        return bool(outcome.stopped or outcome.raised) or outcome.ended

    def read(self, payload: bytes) -> None:
        """Take one journal message of this run, in order."""
        if self.is_over:
            return
        try:
            for entry in entries([Journal.FromString(payload)]):
                if entry.number != self._next:
                    raise ValueError(self._hole(entry))  # noqa: TRY301  (all that is wrong with a batch ends alike)
                self._next += 1
                self._queue.append(entry)
        except (ValueError, DecodeError) as damage:
            self.advance()
            self._stop(str(damage) or "a journal message is damaged")
        else:
            self.advance()

    def advance(self) -> None:
        """Hand over the events whose messages are there."""
        while self._queue and not self.is_over:
            if self._queue[0].port == LOADED:
                self._go_on()
                continue
            event = self._event(self._queue[0])
            if event is None:
                return
            self._queue.popleft()
            self._hand(event)

    def _go_on(self) -> None:
        """Load the snapshot that the run was given: what the replay of the former run has said, never the log's."""
        entry = self._queue[0]
        payload = self._snapshots.get((entry.source_run, entry.source_sequence))
        if payload is None:
            former = f"snapshot {entry.source_sequence} of run {entry.source_run:016x}"
            self._stop(f"it went on from {former}, which the replay of that run has not given again")
            return
        try:
            self._hosted.load(payload)
        except ValueError as reason:
            self._stop(f"the snapshot that it went on from can not be loaded: {reason}")
            return
        self.outcome.went_on = True
        self._queue.popleft()

    def finish(self) -> Outcome:
        """No message comes any more: what is still awaited is missing."""
        self.advance()
        if self._queue and not self.is_over:
            self._stop(self._missing(self._queue[0]))
        return self.outcome

    def _event(self, entry: Entry) -> Event | None:
        """The event of an entry; None if its message is not here (yet)."""
        window = self._windows.get(entry.port)
        if window is None:
            return self._own_event(entry)
        logged = window.take(entry.source_run, entry.source_sequence)
        if logged is None:
            if window.has_passed(entry.source_run, entry.source_sequence):
                self._stop(self._missing(entry))
            return None
        try:
            message = self._hosted.decode(entry.port, logged.payload)
        except DecodeError:
            self._stop(f"{self._named(entry)} is damaged")
            return None
        return Event(entry.time_ns, entry.port, message, logged.capture_ns, entry.source_run, entry.source_sequence)

    def _own_event(self, entry: Entry) -> Event | None:
        """An event that the shell made itself: a tick, a stall, a death, the stop."""
        port, _, name = entry.port.partition(":")
        declared = self._hosted.inputs.get(port)
        if isinstance(declared, Port):
            self._stop(f"the launch file wires nothing to {self._spec.name}.{port}")
            return None
        if port != STOP and declared is None:
            self._stop(f"{self._spec.name} has no input {entry.port!r}")
            return None
        message: Any = name if port == GONE else None
        return Event(entry.time_ns, port, message, entry.time_ns, entry.source_run)

    def _hand(self, event: Event) -> None:
        outcome = self.outcome
        outcome.events += 1
        outcome.until_ns = event.time_ns
        try:
            samples = self._hosted.handle(event)
        except Exception as error:  # noqa: BLE001  (a component that now fails where it did not is a finding)
            outcome.raised = f"{type(error).__name__} at {event.time_ns / 1e9:.3f} s on {event.port}: {error}"
            return
        for sample in samples:
            outcome.outputs[sample.key] = outcome.outputs.get(sample.key, 0) + 1
            self._tell(sample)
        outcome.ended = event.port == STOP

    def _stop(self, why: str) -> None:
        if not self.is_over:
            self.outcome.stopped = why
            if self._queue:
                self.outcome.until_ns = self._queue[0].time_ns
            self._queue.clear()

    def _missing(self, entry: Entry) -> str:
        return f"{self._named(entry)} is missing"

    def _named(self, entry: Entry) -> str:
        return f"message {entry.source_sequence} of {self._spec.inputs.get(entry.port, entry.port)}"

    def _hole(self, entry: Entry) -> str:
        if entry.number < self._next:
            return f"the journal has event {entry.number} twice"
        return f"events {self._next} to {entry.number - 1} of the journal of {self._spec.name} are missing"
