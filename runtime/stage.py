"""A player's place on the bus: a realm of its own, or that of a running system in which it stands in for somebody."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import partial

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
from runtime.wire import Refused, Stamp, encoding_of_name, new_run, pack_stamp, unpack_stamp
from runtime.wishes import EPOCH, ask

CLOCK_KEY = "player/clock"
_SUPERVISOR = "supervisor"
_POLL_S = 0.01


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
        self._former: set[int] = set()
        """Runs of a former epoch."""

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

    def listen(self, key: str, call: Callable[[int], None]) -> None:
        """Call with the capture time of each message of a key, on zenoh's thread."""
        self._session.declare_subscriber(f"{self._realm}/{key}", direct(partial(self._hear, call)))

    def _hear(self, call: Callable[[int], None], sample: zenoh.Sample) -> None:
        try:
            stamp = unpack_stamp(sample.attachment.to_bytes() if sample.attachment is not None else b"")
        except Refused:
            return  # its readers count it
        if stamp.run not in self._former:
            call(stamp.capture_ns)

    def leave(self) -> None:
        """End the runs announced so far."""
        for tokens in self._tokens.values():
            for token in tokens:
                token.undeclare()  # type: ignore[no-untyped-call]  # not annotated in zenoh's stubs
        self._tokens.clear()

    def forget(self) -> None:
        """Hear nothing more of those who speak now: they belong to an epoch that is over."""

    def begin_epoch(self, is_over: Callable[[], bool]) -> None:
        """Let those who listen begin anew; in a realm of one's own the new run ids say it all."""


class JoinedStage(Stage):
    """The realm of a running system, whose components can be started anew."""

    def __init__(
        self, session: zenoh.Session, realm: str, hows: Mapping[str, Qos], presence: Presence, system: System
    ) -> None:
        """Publish in a running system's realm.

        Args:
            session: open.
            realm: prefix of all keys.
            hows: as for every stage.
            presence: of the running components.
            system: that runs there.
        """
        super().__init__(session, realm, hows)
        self._presence = presence
        self._system = system

    def forget(self) -> None:
        """See `Stage.forget`."""
        for spec in self._system.here:  # taps too: their time goes on
            self._former |= self._presence.runs(LISTENS, spec.name)

    def begin_epoch(self, is_over: Callable[[], bool]) -> None:
        """Have every fold started anew, and wait until all are ready.

        Args:
            is_over: whether nobody needs that any more.

        Raises:
            ComponentError: the supervisor refuses, or somebody does not get ready.
        """
        if not ask(self._session, self._realm, EPOCH, READY_TIMEOUT_S):
            raise ComponentError(f"{self._realm} has nobody who could begin a new epoch")
        folds = [spec.name for spec in self._system.here if not spec.tap]
        deadline_s = time.monotonic() + READY_TIMEOUT_S
        while waited := [name for name in folds if not self._presence.runs(STARTS, name) - self._former]:
            if is_over():
                return
            if time.monotonic() > deadline_s:
                raise ComponentError(f"no sign of {', '.join(waited)} in {self._realm} after a new epoch")
            time.sleep(_POLL_S)


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
        hows = {key: qos(kind, session.system.clock) for key, kind in kinds.items()}
        yield JoinedStage(bus, run.realm, hows, presence, session.system)
