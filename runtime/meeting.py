"""This host's half of a system on the bus, and what it hears of the other halves."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import zenoh

from runtime.bus import direct
from runtime.foreign_thread import keep_thread_state
from runtime.neighbours import HERE, OVER, Half, Neighbours, Verdict, half_keys, parse_half
from runtime.params import ConfigurationError
from runtime.system import System


class Meeting:
    """Says that this half is there, notes in a log who comes and goes. Does nothing in a system of one host."""

    def __init__(
        self, system: System, run: int, end: Callable[[str], None], fail: Callable[[BaseException], None]
    ) -> None:
        """Nothing is said before `open`.

        Args:
            system: with `host`.
            run: id of this host's supervisor.
            end: called on zenoh's thread with the reason why the session is over.
            fail: called on zenoh's thread with what makes this half impossible.
        """
        self._system = system
        self._neighbours = Neighbours(system, run)
        self._end, self._fail = end, fail
        self._session: zenoh.Session | None = None
        self._tokens: list[zenoh.LivelinessToken] = []
        self._log: Path | None = None
        self.begun = False
        """Whether the components of this host have been at work; from then on no newcomer can end it."""

    @property
    def note(self) -> str:
        """Which hosts were there and are out of reach; empty = none."""
        return "; ".join(list(self._neighbours.away.values()))

    def open(self, session: zenoh.Session, log: Path) -> None:
        """Declare this half and follow the others."""
        if self._system.host:
            self._session, self._log = session, log
            for state, heed in ((HERE, self._meet), (OVER, self._part)):
                keys = half_keys(self._system.realm, state)
                session.liveliness().declare_subscriber(keys, direct(self._receiver(heed)), history=True)
            links = zenoh.handlers.Callback(self._look_at, indirect=False)
            session.info.declare_link_events_listener(links, history=True)
            self._declare(HERE)

    def close(self) -> None:
        """Tell the others that this half ends in order, and not for want of a link."""
        if self._session is not None:
            self._declare(OVER)
            self._session = None

    def _declare(self, state: str) -> None:
        if self._session is not None:
            key = self._neighbours.own.key(self._system.realm, state)
            self._tokens.append(self._session.liveliness().declare_token(key))

    def _receiver(self, heed: Callable[[Half, bool], None]) -> Callable[[zenoh.Sample], None]:
        def receive(sample: zenoh.Sample) -> None:
            try:
                heed(parse_half(str(sample.key_expr)), sample.kind == zenoh.SampleKind.PUT)
            except ValueError:
                return  # a stranger's token
            except Exception as failure:  # noqa: BLE001  (zenoh would swallow it)
                self._fail(failure)

        return receive

    def _look_at(self, event: zenoh.LinkEvent) -> None:
        """Note who has come with a key and has no part here: the access control lets it neither speak nor hear."""
        keep_thread_state()
        name = event.link.auth_identifier
        if event.kind == zenoh.SampleKind.PUT and name and name not in self._system.other_hosts:
            self._note(Verdict(f"{name} at {event.link.dst} has a key and no part in this system; it is not heard"))

    def _meet(self, half: Half, appeared: bool) -> None:
        verdict = self._neighbours.appear(half, begun=self.begun) if appeared else self._neighbours.vanish(half)
        self._note(verdict)
        if verdict.fatal:
            self._fail(ConfigurationError(f"{self._system.file}: {verdict.words}"))

    def _part(self, half: Half, appeared: bool) -> None:
        verdict = self._neighbours.end(half) if appeared else Verdict()
        self._note(verdict)
        if verdict.fatal:
            self._end(verdict.words)

    def _note(self, verdict: Verdict) -> None:
        if verdict.words and self._log is not None:
            with self._log.open("a", encoding="utf-8") as stream:
                stream.write(f"{datetime.now(UTC).isoformat(timespec='milliseconds')} {verdict.words}\n")
