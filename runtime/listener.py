"""Hears a running system from outside: everything that its components say, and nothing of its own on the bus."""

from __future__ import annotations

import time
from collections.abc import Collection
from types import TracebackType
from typing import Self

from runtime.bus import direct, is_listened_on, open_observer, parse_ready_key, ready_keys
from runtime.door import FAILURE, Door, Lane
from runtime.inbox import Arrival, Inbox, Notice
from runtime.joining import await_links
from runtime.presence import LISTENS, STARTS, Presence, watch
from runtime.runfile import Run
from runtime.wire import encoding_of_name
from runtime.wishes import GO_ON, PAUSE, ask

_QUEUE = 8192
_RUN_IN_S = 0.3
_SUPERVISOR = "supervisor"


class Listener:
    """A subscriber that joins late. Use as a context manager."""

    def __init__(self, run: Run, keys: Collection[str], *, block: bool) -> None:
        """Subscribe to some of a system's keys.

        Args:
            run: the running system.
            keys: below the realm; each must be one of `run.topics`.
            block: hold the publishers back rather than lose a message (lockstep).

        Raises:
            ConfigurationError: the system is not there any more.
        """
        self._endpoint = run.endpoint
        self._inbox = Inbox()
        self._door = Door(self._inbox)
        self._presence = Presence((_SUPERVISOR,))
        self._began = False
        self._box = self._inbox.box("bus", _QUEUE, block=block)
        self._session = open_observer(run.endpoint)
        for key in keys:
            encoding = encoding_of_name(run.topics[key])
            self._door.add(f"{run.realm}/{key}", Lane(self._box, key, encoding, publisher=""))
        present = self._present(run.realm)
        for _, name, number in present:
            self._door.announce(name, number, first=None)  # it has been talking before we came
        await_links(self._session, len({name for _, name, _ in present} - {_SUPERVISOR}))
        watch(self._session, run.realm, self._presence, self._changed, self._failed)
        # zenoh loses some messages while its routes to a late subscriber settle (seen): hold time, and none come.
        paused = block and ask(self._session, run.realm, PAUSE)
        for key in keys:
            self._session.declare_subscriber(f"{run.realm}/{key}", direct(self._door.receive))
        present += self._present(run.realm)  # whoever has answered this knows of our subscriptions
        if any(stage == STARTS and name != _SUPERVISOR for stage, name, _ in present):
            self._run_in()
        if paused:
            ask(self._session, run.realm, GO_ON)

    def _present(self, realm: str) -> list[tuple[int, str, int]]:
        replies = self._session.liveliness().get(ready_keys(realm), timeout=1.0)
        return [parse_ready_key(str(reply.ok.key_expr)) for reply in replies if reply.ok is not None]

    def _run_in(self) -> None:
        """Forget the first moments."""
        until_s = time.monotonic() + _RUN_IN_S
        while (left_s := until_s - time.monotonic()) > 0:
            self.take(left_s)

    def _changed(self, appeared: bool, stage: int, name: str, run: int) -> None:
        if appeared and stage == LISTENS:
            self._door.announce(name, run, first=0)

    def _failed(self, failure: BaseException) -> None:
        self._inbox.notify(Notice(FAILURE, failure))

    @property
    def is_over(self) -> bool:
        """Whether the system has ended: its supervisor is away, and not only late on a machine that is too busy."""
        there = bool(self._presence.runs(LISTENS, _SUPERVISOR))
        self._began |= there
        return self._began and not there and not is_listened_on(self._endpoint)

    @property
    def refused(self) -> int:
        """Messages that were not to be believed."""
        return self._door.refusals.count

    @property
    def dropped(self) -> int:
        """Messages for which there was no room."""
        return self._box.dropped

    def take(self, timeout_s: float) -> Arrival | None:
        """The next message, or None if nothing came in time."""
        entry = self._inbox.take(timeout_s)
        if isinstance(entry, Notice):
            if entry.port == FAILURE:
                raise entry.message
            return None
        return entry

    def __enter__(self) -> Self:
        """Listen."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the bus."""
        self._inbox.shut()
        self._session.close()  # type: ignore[no-untyped-call]  # not annotated in zenoh's stubs
