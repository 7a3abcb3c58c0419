"""Who is there: the liveliness tokens of a system, and the start barrier made of them."""

from __future__ import annotations

from collections.abc import Callable
from threading import Condition

import zenoh

from runtime.bus import direct, parse_ready_key, ready_keys

LISTENS, STARTS = 1, 2
"""Stages of a token: its subscribers are declared; it has seen that all others' are."""


class Presence:
    """The tokens seen so far. Written by zenoh's thread, awaited by the main one."""

    def __init__(self, names: tuple[str, ...]) -> None:
        """Wait for these components."""
        self._names = names
        self._runs: dict[tuple[int, str], set[int]] = {}
        self._changed = Condition()

    def appear(self, stage: int, name: str, run: int) -> None:
        """A token has appeared."""
        with self._changed:
            self._runs.setdefault((stage, name), set()).add(run)
            self._changed.notify_all()

    def vanish(self, stage: int, name: str, run: int) -> None:
        """A token has vanished."""
        with self._changed:
            self._runs.get((stage, name), set()).discard(run)
            self._changed.notify_all()

    def missing(self, stage: int) -> list[str]:
        """Components that have not reached a stage."""
        with self._changed:
            return self._missing(stage)

    def runs(self, stage: int, name: str) -> set[int]:
        """Run ids of a component at a stage."""
        with self._changed:
            return set(self._runs.get((stage, name), ()))

    def is_announced(self, stage: int, name: str, run: int) -> bool:
        """Whether a run of a component is at a stage; an empty name stands for every component."""
        with self._changed:
            return any(run in runs for (at, other), runs in self._runs.items() if at == stage and name in {"", other})

    def wait(self, stage: int, timeout_s: float) -> bool:
        """Wait until nobody is missing at a stage; False if that took too long."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._missing(stage), timeout_s)

    def is_alone(self, name: str) -> bool:
        """Whether everybody but one component is gone."""
        with self._changed:
            return not any(runs for (_, other), runs in self._runs.items() if other in self._names and other != name)

    def _missing(self, stage: int) -> list[str]:
        return [name for name in self._names if not self._runs.get((stage, name))]


def watch(
    session: zenoh.Session,
    realm: str,
    presence: Presence,
    on_change: Callable[[bool, int, str, int], None],
    on_failure: Callable[[BaseException], None],
) -> None:
    """Follow a realm's tokens, those included that are there already.

    Args:
        session: of this process.
        realm: of the system.
        presence: is kept up to date.
        on_change: called on zenoh's thread with (appeared, stage, component, run), before `presence` changes.
        on_failure: called on zenoh's thread with what `on_change` raised.
    """

    def receive(sample: zenoh.Sample) -> None:
        try:
            stage, name, run = parse_ready_key(str(sample.key_expr))
            appeared = sample.kind == zenoh.SampleKind.PUT
            on_change(appeared, stage, name, run)
            (presence.appear if appeared else presence.vanish)(stage, name, run)
        except ValueError:
            return  # a stranger's token
        except Exception as failure:  # noqa: BLE001  (zenoh would swallow it)
            on_failure(failure)

    session.liveliness().declare_subscriber(ready_keys(realm), direct(receive), history=True)
