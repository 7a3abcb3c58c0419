"""The other hosts of a system: whether they are there, and whether they run the same system. Pure."""

from __future__ import annotations

import hashlib
import json
import re
from typing import NamedTuple

from runtime.system import System, ports_of

HERE, OVER = "@half", "@over"
"""Verbatim chunks: `REALM/**` does not match them. The second one is declared at an orderly end."""
_TOKEN = re.compile(r"(?P<realm>.+)/@(half|over)/(?P<host>[^/]+)/(?P<digest>[0-9a-f]{16})/(?P<run>[0-9a-f]{16})")


class Half(NamedTuple):
    """One host's part of a system, as its liveliness token says."""

    host: str
    digest: str
    """Of the whole system; equal on all hosts."""
    run: int
    """Of the host's supervisor."""

    def key(self, realm: str, state: str = HERE) -> str:
        """Of the token that says `HERE` or `OVER`."""
        return f"{realm}/{state}/{self.host}/{self.digest}/{self.run:016x}"


class Verdict(NamedTuple):
    """What the appearance or the loss of a host means."""

    words: str = ""
    """One line for the log; empty = nothing to say."""
    fatal: bool = False
    """This host's part of the session can not begin, or is over."""


def half_keys(realm: str, state: str) -> str:
    """All such tokens of a realm."""
    return f"{realm}/{state}/*/*/*"


def parse_half(key: str) -> Half:
    """Inverse of `Half.key`.

    Raises:
        ValueError: it is nothing of the kind.
    """
    found = _TOKEN.fullmatch(key)
    if found is None:
        raise ValueError(f"not a half's token: {key!r}")
    return Half(found["host"], found["digest"], int(found["run"], 16))


def digest_of(system: System) -> str:
    """Of everything that must be equal on all hosts: components, wires, parameters, clock, seed; not file names."""
    table = json.loads(system.to_json())
    for key in ("file", "host", "keys", "text"):
        del table[key]
    for spec in table["components"]:
        spec["params"] = {k: v for k, v in spec["params"].items() if not (spec["tap"] and k == "file")}
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()[:16]


class Neighbours:
    """Follows the halves of a system. All methods that change it are called by one thread."""

    def __init__(self, system: System, run: int) -> None:
        """Nobody was seen.

        Args:
            system: with `host`.
            run: id of this host's supervisor.
        """
        self.own = Half(system.host, digest_of(system), run)
        self._expected = system.other_hosts
        self._drivers = {spec.host for spec in system.components if _answers_frames(spec.run)}
        self._runs: dict[str, int] = {}
        """Host -> the run seen last."""
        self._seconds: dict[str, int] = {}
        """Host -> a run that appeared while the one before is there: its successor, or another machine's mistake."""
        self.away: dict[str, str] = {}
        """Host that was there -> what was said when it went."""

    def appear(self, half: Half, *, begun: bool) -> Verdict:
        """A half is there.

        Args:
            half: of any host.
            begun: whether the session runs already on this host; then nobody new can end it.
        """
        if half == self.own:
            return Verdict()
        if half.host == self.own.host:
            return Verdict(f"host {half.host} must run once; another machine runs it, too", fatal=not begun)
        if half.host not in self._expected or half.digest != self.own.digest:
            return self._stranger(half, begun=begun)
        before = self._runs.setdefault(half.host, half.run)
        if before != half.run and half.host not in self.away:
            self._seconds[half.host] = half.run
            return Verdict(f"a second machine runs {half.host}; {self.own.host} stays with the first")
        was_away = self.away.pop(half.host, None) is not None
        if before == half.run:
            return Verdict(f"{half.host} is {'back' if was_away else 'there'}")
        return self._succeed(half)

    def _succeed(self, half: Half) -> Verdict:
        self._runs[half.host] = half.run
        if self._depends_on(half.host):
            return Verdict(f"{half.host} has begun another session; start this host again", fatal=True)
        return Verdict(f"{half.host} was started again and is there")

    def vanish(self, half: Half) -> Verdict:
        """A half is not there any more: it has ended, or the link is down."""
        second = self._seconds.get(half.host)
        if second == half.run:
            del self._seconds[half.host]
        if self._runs.get(half.host) != half.run or half.host in self.away:
            return Verdict()
        if second is not None:
            return self._succeed(half._replace(run=self._seconds.pop(half.host)))
        self.away[half.host] = f"{half.host} is away; {self.own.host} goes on without it"
        return Verdict(self.away[half.host])

    def end(self, half: Half) -> Verdict:
        """A half ends in order: so does this one if it only learns or looks on."""
        if self._runs.get(half.host) != half.run:
            return Verdict()
        return Verdict(f"{half.host} has ended", fatal=self._depends_on(half.host))

    def _depends_on(self, host: str) -> bool:
        """Whether the robot's frames are answered there and not here."""
        return host in self._drivers and self.own.host not in self._drivers

    def _stranger(self, half: Half, *, begun: bool) -> Verdict:
        words = (
            f"host {half.host} must run the same system; start all hosts with the same launch file, --set, --only, "
            "--clock, --seed and --no-record"
        )
        return Verdict(words, fatal=not begun)


def _answers_frames(run: str) -> bool:
    return any(port.per_frame for port in ports_of(run).OUTPUTS.values())
