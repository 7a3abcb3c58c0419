"""A player's place on the bus: a realm of its own, or that of a running system in which it stands in for somebody."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime

import zenoh

from runtime.assignment import READY_TIMEOUT_S, Assignment
from runtime.bus import direct, free_endpoint, open_observer, open_router, ready_key
from runtime.contract import ComponentError, Kind
from runtime.joining import await_links, describe
from runtime.params import ConfigurationError
from runtime.playlist import Playlist
from runtime.presence import LISTENS, STARTS, Presence, watch
from runtime.qos import JOURNAL, Qos, qos
from runtime.runfile import Run, claim
from runtime.system import System
from runtime.wire import Stamp, encoding_of_name, new_run, pack_stamp

CLOCK_KEY = "player/clock"
_SUPERVISOR = "supervisor"


class Stage:
    """Publishes messages of others as if it were they: their keys, their tokens."""

    def __init__(self, session: zenoh.Session, realm: str, hows: Mapping[str, Qos]) -> None:
        """Publish in a realm.

        Args:
            session: open.
            realm: prefix of all keys.
            hows: key -> how it travels; the others block, so that nothing is lost.
        """
        self._session = session
        self._realm = realm
        self._hows = hows
        self._publishers: dict[str, zenoh.Publisher] = {}
        self._tokens: dict[tuple[str, int], list[zenoh.LivelinessToken]] = {}

    def put(self, key: str, schema: str, payload: bytes, owner: str, stamp: Stamp) -> None:
        """Publish one message as a component; its run is announced first."""
        if (owner, stamp.run) not in self._tokens:
            self._announce(owner, stamp.run)
        publisher = self._publishers.get(key) or self._declare(key, schema)
        publisher.put(payload, attachment=pack_stamp(*stamp))

    def _announce(self, owner: str, run: int) -> None:
        tokens = self._session.liveliness()
        self._tokens[owner, run] = [
            tokens.declare_token(ready_key(self._realm, stage, owner, run)) for stage in (LISTENS, STARTS)
        ]

    def _declare(self, key: str, schema: str) -> zenoh.Publisher:
        how = self._hows.get(key, JOURNAL)
        self._publishers[key] = self._session.declare_publisher(
            f"{self._realm}/{key}",
            encoding=zenoh.Encoding(encoding_of_name(schema)),
            priority=how.priority,
            congestion_control=how.congestion,
            allowed_destination=zenoh.Locality.REMOTE,
        )
        return self._publishers[key]

    def listen(self, key: str, call: Callable[[zenoh.Sample], None]) -> None:
        """Call with each sample of a key, on zenoh's thread."""
        self._session.declare_subscriber(f"{self._realm}/{key}", direct(call))

    def leave(self) -> None:
        """End the runs announced so far."""
        for tokens in self._tokens.values():
            for token in tokens:
                token.undeclare()  # type: ignore[no-untyped-call]  # not annotated in zenoh's stubs
        self._tokens.clear()


@contextmanager
def own_stage(playlist: Playlist, realm: str) -> Iterator[Stage]:
    """A realm with a router and a run file of its own, so that the commands that look at a system find it.

    Raises:
        ConfigurationError: the realm is busy.
    """
    started = datetime.now(UTC).isoformat(timespec="milliseconds")
    names = tuple(sorted(set(playlist.owners.values())))
    topics = {**playlist.topics, CLOCK_KEY: "berth.Playback"}
    endpoint = free_endpoint()
    with open_router(endpoint) as session, claim(realm, endpoint, started, str(playlist.file), names, topics) as run:
        system = _as_system(playlist, realm)
        describe(run, Assignment(system, "", names, endpoint, time.monotonic_ns(), started))
        token = session.liveliness().declare_token(ready_key(realm, LISTENS, _SUPERVISOR, new_run()))
        yield Stage(session, realm, {})
        token.undeclare()  # type: ignore[no-untyped-call]  # not annotated in zenoh's stubs


def _as_system(playlist: Playlist, realm: str) -> System:
    """The played session, for whoever records it again: its time is what its messages say, as in lockstep."""
    seed = playlist.launch.get("seed")
    return System(
        file=str(playlist.file),
        realm=realm,
        clock="lockstep",
        pace=None,
        seed=seed if isinstance(seed, int) else 0,
        stall_s=10.0,
        end="",
        trial="",
        truth="",
        components=(),
        text=json.dumps({**playlist.launch, "realm": realm}, indent=1, sort_keys=True),
    )


@contextmanager
def joined_stage(run: Run, session: Assignment, playlist: Playlist, kinds: Mapping[str, Kind]) -> Iterator[Stage]:
    """A running system's realm, once all of its components are ready.

    Args:
        run: the running system.
        session: its description.
        playlist: what will be played in it.
        kinds: key -> what it carries.

    Raises:
        ConfigurationError: it is not there, or runs one of the components that are to be replaced.
        ComponentError: its components do not get ready.
    """
    for name in sorted(set(playlist.owners.values()) & set(run.components)):
        raise ConfigurationError(f"--replace {name}: must not run in {run.realm}; start it with --only and the others")
    presence = Presence(run.components)
    with open_observer(run.endpoint) as bus:
        watch(bus, run.realm, presence, lambda *_: None, lambda _: None)
        if not presence.wait(STARTS, READY_TIMEOUT_S):
            raise ComponentError(f"no sign of {', '.join(presence.missing(STARTS))} in {run.realm}")
        await_links(bus, len(run.components))
        yield Stage(bus, run.realm, {key: qos(kind, session.system.clock) for key, kind in kinds.items()})
