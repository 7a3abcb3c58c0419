"""A process's place on the bus: session, inbox, door, outlets, and the start barrier."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import zenoh

from runtime.assignment import Assignment
from runtime.bus import direct, open_peer, ready_key
from runtime.contract import GONE, ComponentError, Port
from runtime.door import FAILURE, Door, Lane
from runtime.inbox import Box, Inbox, Notice
from runtime.outlet import Outlets
from runtime.presence import LISTENS, STARTS, Presence, watch
from runtime.wire import encoding_of
from schemas.session_pb2 import Status

_SLICE_S = 0.1
"""How long the barrier waits before it looks whether it shall stop."""


class Stop:
    """The wish to stop, set by a signal handler: only assignments and one reentrant put."""

    def __init__(self) -> None:
        """Nobody wishes to stop."""
        self.asked = False
        self.wake: Callable[[], None] | None = None

    def ask(self) -> None:
        """Ask; may be repeated."""
        self.asked = True
        if self.wake is not None:
            self.wake()


class Station:
    """One component's session on the bus."""

    def __init__(self, assignment: Assignment, outputs: Mapping[str, Port], run: int, stop: Stop) -> None:
        """Connect and declare the publishers. Nothing is received before `subscribe`."""
        self.assignment = assignment
        self.system = assignment.system
        self.spec = assignment.system.component(assignment.name)
        self.stop = stop
        self.run = run
        self.inbox = Inbox()
        self.door = Door(self.inbox)
        self.presence = Presence(assignment.peers)
        self.note = ""
        """The newest stall, in words; a refusal has a note of its own."""
        self._names = {spec.name for spec in self.system.components}
        self._started = False
        self._tokens: list[zenoh.LivelinessToken] = []
        stop.wake = lambda: self.inbox.notify(Notice("wake"))
        self.session = open_peer(assignment.endpoint)
        self.outlets = Outlets(self.session, self.system.realm, assignment.name, self.run, self.system.clock, outputs)
        self.outlets.declare(self.spec.outputs)

    def lane(self, box: Box, key: str, schema: type[Any], publisher: str) -> None:
        """Let a key below the realm into a box, if this component (or `supervisor`) publishes it."""
        self.door.add(f"{self.system.realm}/{key}", Lane(box, key, encoding_of(schema), publisher))

    def subscribe(self, key: str) -> None:
        """Subscribe to a key below the realm; wildcards allowed."""
        self.session.declare_subscriber(f"{self.system.realm}/{key}", direct(self.door.receive))

    def join(self) -> None:
        """Pass the start barrier, after all `subscribe`; returns early when asked to stop.

        Raises:
            ComponentError: a peer did not come in time; it is named.
        """
        watch(self.session, self.system.realm, self.presence, self._peer_changed, self.failed)
        for stage in (LISTENS, STARTS):
            key = ready_key(self.system.realm, stage, self.assignment.name, self.run)
            self._tokens.append(self.session.liveliness().declare_token(key))
            self._await(stage)
        self._started = True

    def _await(self, stage: int) -> None:
        waited_s = 0.0
        while not self.stop.asked and not self.presence.wait(stage, _SLICE_S):
            waited_s += _SLICE_S
            if waited_s >= self.assignment.ready_timeout_s:
                missing = ", ".join(self.presence.missing(stage))
                raise ComponentError(f"no sign of {missing} after {waited_s:.0f} s")

    def _peer_changed(self, appeared: bool, stage: int, name: str, run: int) -> None:
        if stage != LISTENS:
            return
        if appeared:
            began_before = self.assignment.restarts > 0 and not self._started
            # Another host may have been running for long when this one joins it.
            late = began_before or not self.system.is_here(name)
            self.door.announce(name, run, first=None if late else 0)
        elif self._started and not self.stop.asked and name in self._names:
            self.inbox.notify(Notice(GONE, (name, run)))

    def failed(self, failure: BaseException) -> None:
        """Let the main thread raise what another one met; from any thread."""
        self.inbox.notify(Notice(FAILURE, failure))

    def status(self, handled: int) -> Status:
        """What the once-a-second status says."""
        refusals = self.door.refusals
        return Status(
            component=self.assignment.name,
            handled=handled,
            published=self.outlets.published,
            lost=self.door.lost,
            skipped=sum(box.skipped for box in self.inbox.boxes),
            malformed=refusals.count,
            note=self.note or refusals.note,
        )

    def close(self) -> None:
        """Send what is still under way, then leave the bus."""
        self.inbox.shut()
        self.session.close()  # type: ignore[no-untyped-call]  # not annotated in zenoh's stubs
