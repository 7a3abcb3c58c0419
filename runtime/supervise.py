"""The supervisor: one process per component, and nobody left behind."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import zenoh

from runtime.assignment import READY_TIMEOUT_S, Assignment
from runtime.bus import ALONE, direct, free_endpoint, open_router, ready_key
from runtime.child import Child
from runtime.device import lay_to_rest
from runtime.joining import describe
from runtime.keeper import Keeper
from runtime.link import Link
from runtime.live import HOLD_KEY
from runtime.meeting import Meeting
from runtime.member import Death, Member, kill_who_stays
from runtime.outlet import Outlet
from runtime.presence import LISTENS, STARTS, Presence, watch
from runtime.qos import JOURNAL
from runtime.restart import Restarts
from runtime.runfile import Run, claim
from runtime.standstill import Standstill
from runtime.system import ComponentSpec, System
from runtime.tap import known_keys
from runtime.watcher import Watcher
from runtime.wire import new_run
from runtime.wishes import EPOCH, GO_ON, PAUSE, Wishes
from schemas.session_pb2 import Hold, Status

NAME = "supervisor"
_FOLDS_S, _TAPS_S = 1.2, 5.0
"""Time to stop before SIGKILL: first for the folds, whose devices must rest, then for the taps, which record the folds'
last messages. A tap needs 0.1 s; on a busy machine more, and nothing waits for it."""
_OTHERS_S = 1.5
"""After a session's end: how long this host's taps hear what the other hosts still say."""
_RESET_S = 10.0
"""Time for the folds to stop before a new epoch; nothing moves meanwhile, so nobody needs to be killed for it."""
_POLL_S = 0.01


class Supervisor:
    """Runs a system's components on this host.

    Use as a context manager: leaving it stops everything, whatever happened.
    """

    def __init__(
        self,
        system: System,
        *,
        endpoint: str = "",
        link: Link = ALONE,
        ready_timeout_s: float = READY_TIMEOUT_S,
    ) -> None:
        """Nothing is started before `start`.

        Args:
            system: the resolved launch file; what is `here` in it is run.
            endpoint: where the host's router listens; empty = a free port on loopback.
            link: to another host's router.
            ready_timeout_s: how long the components wait for one another.
        """
        self._system = system
        self._specs = system.here
        self._endpoint = endpoint or free_endpoint()
        self._link = link
        self._ready_timeout_s = ready_timeout_s
        self._names = tuple(spec.name for spec in self._specs)
        self._everybody = tuple(spec.name for spec in system.components)
        self._presence = Presence(self._everybody)
        self._keeper = Keeper(self._presence)
        self._bus_run = new_run()
        self._meeting = Meeting(system, self._bus_run, self._end_everywhere, self._failed)
        self._ends_everywhere = False
        self._members: list[Member] = []
        self._resources = ExitStack()
        self._watched: dict[str, Callable[[Any, int], None]] = {}
        self._run: Run | None = None
        self._standstill: Standstill | None = None
        self._wishes = Wishes()
        self._failure: BaseException | None = None
        self._origin_ns = 0
        self.end_reason = ""
        """Why the session ended or shall end; empty while it runs."""
        self.deaths: list[Death] = []
        self.statuses: dict[str, Status] = {}
        """The newest of each component of this host."""

    @property
    def run(self) -> Run:
        """What the run file says; after `start`."""
        if self._run is None:
            raise RuntimeError("start() comes first")
        return self._run

    @property
    def _time(self) -> Standstill:
        if self._standstill is None:
            raise RuntimeError("start() comes first")
        return self._standstill

    @property
    def exit_code(self) -> int:
        """0 if nobody died who was not started again."""
        return 1 if any(not death.restarted for death in self.deaths) else 0

    @property
    def missing(self) -> list[str]:
        """Components that have not passed the start barrier, or are out of reach."""
        return self._presence.missing(STARTS)

    @property
    def pids(self) -> dict[str, int]:
        """Process ids of the components that run."""
        return {member.spec.name: member.child.pid for member in self._members if member.child.exit_code is None}

    @property
    def note(self) -> str:
        """Which hosts of the system are out of reach; empty = none."""
        return self._meeting.note

    @property
    def restarted(self) -> str:
        """How often somebody was started again, and why the last time; empty = never."""
        again = [death for death in self.deaths if death.restarted]
        return f"{len(again)}; {again[-1].words}" if again else ""

    @property
    def messages(self) -> int:
        """Messages published on output ports, as the components last said."""
        return sum(status.published for status in list(self.statuses.values()))

    @property
    def lost(self) -> int:
        """Messages lost, as the components last said."""
        return sum(status.lost for status in list(self.statuses.values()))

    @property
    def refused(self) -> int:
        """Messages that a component did not believe, as the components last said."""
        return sum(status.malformed for status in list(self.statuses.values()))

    @property
    def refusal(self) -> str:
        """How many messages were refused, and where and why the newest one of some component; empty = none."""
        notes = [f"{s.component}: {s.note}" for s in list(self.statuses.values()) if s.malformed and s.note]
        return f"{self.refused}; {notes[-1] if notes else ''}" if self.refused else ""

    def watch(self, key: str, call: Callable[[Any, int], None]) -> None:
        """Call with every decoded message of a key below the realm and its capture time, on zenoh's thread."""
        self._watched[key] = call

    def start(self) -> None:
        """Claim the realm, open the router, start every process.

        Raises:
            ConfigurationError: the realm or the endpoint is busy.
        """
        started = datetime.now(UTC).isoformat(timespec="milliseconds")
        system = self._system
        self._run = self._resources.enter_context(
            claim(system.realm, self._endpoint, started, system.file, self._names, _topics(system))
        )
        session = open_router(self._endpoint, self._link, system.clock)
        self._resources.callback(session.close)
        self._open_bus(session)
        self._origin_ns = time.monotonic_ns()
        describe(self._run, Assignment(system, "", self._names, self._endpoint, self._origin_ns, started))
        for spec in self._specs:
            restarts = Restarts(spec.restart, spec.restart_limit)
            self._members.append(Member(spec, restarts, self._spawn(spec, 0)))

    def _open_bus(self, session: zenoh.Session) -> None:
        realm = self._system.realm
        self._standstill = Standstill(Outlet(session, realm, HOLD_KEY, Hold, JOURNAL, self._bus_run))
        key = ready_key(realm, LISTENS, NAME, self._bus_run)
        token = session.liveliness().declare_token(key)
        self._resources.callback(lambda: token)  # lives as long as the session
        self._meeting.open(session, Path(self.run.directory) / f"{NAME}.log")
        watch(session, realm, self._presence, lambda *_: None, self._failed)
        self._keeper.listen(session, realm, self._specs)
        self._wishes.listen(session, realm)
        if self._system.end:
            self._watched.setdefault(self._system.end, lambda *_: None)
        for name in self._names:
            self._watched[f"{name}/status"] = self._take_status
        for key, schema, publisher in known_keys(self._system):
            if key in self._watched:
                call = partial(self._received, key)
                watcher = Watcher(schema, publisher, self._presence, call, self._failed)
                session.declare_subscriber(f"{realm}/{key}", direct(watcher.receive))

    def _received(self, key: str, message: Any, capture_ns: int) -> None:
        if key == self._system.end:
            self._end_everywhere(message.reason or "end")
        self._watched[key](message, capture_ns)

    def _take_status(self, status: Status, _: int) -> None:
        if status.component in self._names:
            self.statuses[status.component] = status

    def _failed(self, failure: BaseException) -> None:
        self._failure = failure

    def _spawn(self, spec: ComponentSpec, restarts: int) -> Child:
        assignment = Assignment(
            system=self._system,
            name=spec.name,
            # Whoever is started again goes on with those that this host can reach by itself.
            peers=self._names if restarts else self._everybody,
            endpoint=self._endpoint,
            origin_ns=self._origin_ns,
            started=self.run.started,
            restarts=restarts,
            ready_timeout_s=self._ready_timeout_s,
            snapshot=self._keeper.kept(spec.name, Path(self.run.directory)) if restarts else None,
        )
        return Child(assignment, Path(self.run.directory) / f"{spec.name}.log")

    def stop_soon(self, reason: str) -> None:
        """Let `poll` report the end; from any thread. The first reason counts."""
        self.end_reason = self.end_reason or reason

    def _end_everywhere(self, reason: str) -> None:
        self._ends_everywhere = True
        self.stop_soon(reason)

    def poll(self, timeout_s: float = 0.1) -> bool:
        """Look after the processes for a while.

        Returns:
            Whether the session goes on; if not, call `stop` (or leave the context).
        """
        deadline_s = time.monotonic() + timeout_s
        while not self.end_reason:
            if self._failure is not None:
                raise self._failure
            for member in self._members:
                self._look_after(member)
            self._wishes.grant({PAUSE: self._pause, GO_ON: self._go_on, EPOCH: self._begin_epoch})
            self._time.look()
            self._meeting.begun |= not set(self._presence.missing(STARTS)) & set(self._names)
            if time.monotonic() >= deadline_s:
                break
            time.sleep(_POLL_S)
        return not self.end_reason

    def _look_after(self, member: Member) -> None:
        if member.due_s is not None:
            if time.monotonic() >= member.due_s:
                member.due_s = None
                member.child = self._spawn(member.spec, member.restarts.count)
        elif (code := member.child.exit_code) is not None:
            self._bury(member, code)
        elif member.spec.name in self._time and member.spec.name not in self._presence.missing(STARTS):
            self._time.release(member.spec.name)

    def _bury(self, member: Member, code: int) -> None:
        lay_to_rest(member.spec)
        words = member.child.describe_end()
        member.child.release()
        delay_s = member.restarts.delay_s(code)
        self.deaths.append(Death(member.spec.name, code, words, restarted=delay_s is not None))
        if delay_s is None:
            self.stop_soon(words)
        else:
            self._time.hold(member.spec.name)
            member.due_s = time.monotonic() + delay_s

    def _pause(self) -> str:
        if self._system.clock != "lockstep":
            return f"{self._system.realm} runs in real time, which can not be held"
        self._time.pause()
        return ""

    def _go_on(self) -> str:
        self._time.go_on()
        return ""

    def _begin_epoch(self) -> str:
        """Start every fold anew, as if nothing had been before; taps go on."""
        if self._system.other_hosts:
            return f"{self._system.realm} runs on several hosts; a new epoch can begin only on one"
        folds = [member for member in self._members if not member.spec.tap]
        self._keeper.forget()
        self._end(folds, _RESET_S)
        for member in folds:
            member.due_s = None
            member.child = self._spawn(member.spec, max(1, member.restarts.count))
        return ""

    def stop(self, reason: str = "stopped") -> None:
        """Stop everything: folds first, then taps; SIGTERM, then SIGKILL. May be called twice."""
        self.stop_soon(reason)
        self._meeting.close()
        self._end([member for member in self._members if not member.spec.tap], _FOLDS_S)
        self._hear_others()
        self._end([member for member in self._members if member.spec.tap], _TAPS_S)
        self._members = []
        self._resources.close()

    def _hear_others(self) -> None:
        """If the session ends on all hosts, what the others say at their stop belongs into this host's recording."""
        deadline_s = time.monotonic() + (_OTHERS_S if self._ends_everywhere else 0.0)
        theirs = {spec.name for spec in self._system.components if not spec.tap} - set(self._names)
        while theirs - set(self._presence.missing(LISTENS)) and time.monotonic() < deadline_s:
            time.sleep(_POLL_S)

    def _end(self, members: list[Member], grace_s: float) -> None:
        for member in members:
            self._note_end(member)
        self.deaths += kill_who_stays(members, grace_s)
        for member in members:
            member.child.release()

    def _note_end(self, member: Member) -> None:
        """Whoever ended since the last look ended unasked, too."""
        code = member.child.exit_code
        if code is not None and member.due_s is None and not any(d.name == member.spec.name for d in self.deaths):
            self.deaths.append(Death(member.spec.name, code, member.child.describe_end(), restarted=False))

    def __enter__(self) -> Self:
        """Start."""
        try:
            self.start()
        except BaseException:
            self.stop("could not start")
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop."""
        self.stop("stopped" if error is None else type(error).__name__)


def _topics(system: System) -> dict[str, str]:
    return {key: schema.DESCRIPTOR.full_name for key, schema, _ in known_keys(system)}
