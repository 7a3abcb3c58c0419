"""The door of a process: what comes from the bus is checked here before it may enter the inbox."""

from __future__ import annotations

from collections.abc import Callable

import zenoh

from runtime.inbox import Arrival, Box, Inbox, Notice
from runtime.sequence import Sequences
from runtime.wire import Refused, schema_name, unpack_stamp

FAILURE = "failure"
"""Notice of an exception on one of zenoh's threads, which zenoh itself would swallow."""
_NOTE_LENGTH = 200


class Refusals:
    """What was refused: a number and the newest reason."""

    def __init__(self) -> None:
        """Nothing was refused."""
        self.count = 0
        self.note = ""

    def add(self, key: str, reason: Refused) -> None:
        """Count one."""
        self.count += 1
        self.note = f"{key}: {reason}"[:_NOTE_LENGTH]


class Lane:
    """One key that may pass."""

    def __init__(self, box: Box, key: str, encoding: str, publisher: str) -> None:
        """Expect this encoding from this component, or `supervisor`, or (empty) whoever is of this realm."""
        self.box = box
        self.key = key
        self.encoding = encoding
        self.schema = schema_name(encoding)
        self.publisher = publisher
        self.sequences = Sequences()


class Door:
    """Called on zenoh's threads with every sample."""

    def __init__(self, inbox: Inbox) -> None:
        """A door into an inbox, without any lane yet."""
        self._inbox = inbox
        self._lanes: dict[str, Lane] = {}
        self.refusals = Refusals()
        self.serve: Callable[[], None] | None = None
        """Called after each arrival, on zenoh's thread; None = somebody looks into the inbox by himself."""

    def add(self, full_key: str, lane: Lane) -> None:
        """Let one key (with its realm) pass."""
        self._lanes[full_key] = lane

    def announce(self, publisher: str, run: int, *, first: int | None) -> None:
        """A component's run may pass from now on; `first` as in `Sequences.expect`."""
        for lane in self._lanes.values():
            if lane.publisher in {"", publisher}:
                lane.sequences.expect(run, first)

    def receive(self, sample: zenoh.Sample) -> None:
        """Check a sample and leave it in the inbox, or count it as refused."""
        key = str(sample.key_expr)
        try:
            self._inbox.put(self._checked(key, sample))
            if self.serve is not None:
                self.serve()
        except Refused as reason:
            self.refusals.add(key, reason)
        except Exception as failure:  # noqa: BLE001  (zenoh would swallow it)
            self._inbox.notify(Notice(FAILURE, failure))

    def _checked(self, key: str, sample: zenoh.Sample) -> Arrival:
        lane = self._lanes.get(key)
        if lane is None:
            raise Refused("no component of this system publishes this key")
        attachment = sample.attachment
        if attachment is None or sample.kind != zenoh.SampleKind.PUT:
            raise Refused("it must be a message with an attachment")
        encoding = str(sample.encoding)
        if encoding != lane.encoding:
            raise Refused(f"encoding must be {lane.encoding}; got {encoding[:80]!r}")
        stamp = unpack_stamp(attachment.to_bytes())
        lane.sequences.receive(stamp.run, stamp.sequence)
        return Arrival(lane.box, lane.key, lane.schema, sample.payload.to_bytes(), stamp)

    @property
    def lost(self) -> int:
        """Holes in the sequences, and samples that a full box had to drop."""
        lanes = self._lanes.values()
        return sum(lane.sequences.lost for lane in lanes) + sum(box.dropped for box in {lane.box for lane in lanes})
