"""What a supervisor does for whoever asks on the bus: let time stand still for a moment, begin a new epoch."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from functools import partial

import zenoh

from runtime.contract import ComponentError
from runtime.foreign_thread import keep_thread_state

PAUSE, GO_ON, EPOCH = "pause", "go-on", "epoch"
_MOST = 16
"""So many wait for the supervisor; who asks beyond is refused."""
PAUSE_S = 2.0
"""Time goes on after so long by itself: who asked may have died."""


def wish_key(realm: str, wish: str) -> str:
    """Key to ask; a verbatim chunk, which `REALM/**` does not match."""
    return f"{realm}/@wish/{wish}"


class Wishes:
    """Those that wait for the supervisor's own thread."""

    def __init__(self) -> None:
        """Nobody has asked."""
        self._waiting: deque[tuple[str, zenoh.Query]] = deque()

    def listen(self, session: zenoh.Session, realm: str) -> None:
        """Let others ask from now on."""
        for wish in (PAUSE, GO_ON, EPOCH):
            handler = zenoh.handlers.Callback(partial(self._take, wish), indirect=False)
            session.declare_queryable(wish_key(realm, wish), handler)

    def _take(self, wish: str, query: zenoh.Query) -> None:
        keep_thread_state()
        if len(self._waiting) < _MOST:
            self._waiting.append((wish, query))
        else:
            with query:
                query.reply_err(f"{_MOST} others wait already")

    def grant(self, grants: Mapping[str, Callable[[], str]]) -> None:
        """Do what was asked for and answer.

        Args:
            grants: wish -> does it; returns why not, empty if it was done.
        """
        while self._waiting:
            wish, query = self._waiting.popleft()
            with query:
                refusal = grants[wish]()
                if refusal:
                    query.reply_err(refusal)
                else:
                    query.reply(str(query.key_expr), b"")


def ask(session: zenoh.Session, realm: str, wish: str, timeout_s: float = 10.0) -> bool:
    """Ask a running system's supervisor, and wait until it is done.

    Returns:
        Whether there was a supervisor.

    Raises:
        ComponentError: it refuses; says why.
    """
    granted = False
    for reply in session.get(wish_key(realm, wish), timeout=timeout_s):
        if reply.err is not None:
            raise ComponentError(reply.err.payload.to_string())
        granted = True
    return granted
