"""Looks at a running system's bus from outside, without being part of it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Event
from typing import NamedTuple

import zenoh

from runtime.bus import direct, open_observer
from runtime.presence import STARTS, Presence, watch
from runtime.runfile import Run
from runtime.wire import Refused, Stamp, schema_name, unpack_stamp

_BACKLOG = 4096


class Seen(NamedTuple):
    """One sample."""

    key: str
    """Below the realm."""
    schema: str
    """Full name, empty if the payload is no protobuf."""
    payload: bytes
    stamp: Stamp | None
    """None if the attachment is missing or malformed."""


class Observer:
    """Samples that have come and were not taken yet; the oldest give way."""

    def __init__(self, realm: str) -> None:
        """Nothing was seen."""
        self._prefix = f"{realm}/"
        self._waiting: deque[Seen] = deque(maxlen=_BACKLOG)
        self._came = Event()

    def receive(self, sample: zenoh.Sample) -> None:
        """Note one sample; on zenoh's thread."""
        attachment = sample.attachment
        stamp = None
        if attachment is not None:
            with suppress(Refused):
                stamp = unpack_stamp(attachment.to_bytes())
        key = str(sample.key_expr).removeprefix(self._prefix)
        self._waiting.append(Seen(key, schema_name(str(sample.encoding)), sample.payload.to_bytes(), stamp))
        self._came.set()

    def take(self, timeout_s: float) -> list[Seen]:
        """What has come; waits for the first one."""
        self._came.wait(timeout_s)
        self._came.clear()
        taken = []
        while self._waiting:
            taken.append(self._waiting.popleft())
        return taken


@contextmanager
def observe(run: Run, keys: str) -> Iterator[Observer]:
    """Subscribe to keys below a running system's realm; wildcards allowed.

    Raises:
        ConfigurationError: the system is not there any more.
    """
    observer = Observer(run.realm)
    with open_observer(run.endpoint) as session:
        session.declare_subscriber(f"{run.realm}/{keys}", direct(observer.receive))
        yield observer


def present(run: Run, timeout_s: float = 2.0) -> list[str]:
    """Components of a running system that have passed the start barrier.

    Args:
        run: the system.
        timeout_s: how long those that are not seen at once are looked for; links come up one by one.
    """
    presence = Presence(run.components)
    with open_observer(run.endpoint) as session:
        watch(session, run.realm, presence, lambda *_: None, lambda _: None)
        presence.wait(STARTS, timeout_s)
        missing = presence.missing(STARTS)
    return [name for name in run.components if name not in missing]
