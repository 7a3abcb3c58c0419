"""The handshake: three packets that the robot echoes. Pure.

A robot that is still open from before sends SIPs instead; it is stopped, closed, and asked again. SYNC0 is its PULSE
and would keep it driving, so it is told to rest before each of them. Over a new network connection nobody is told
anything before SYNC0, because some servers take another packet for a failed handshake; there, what is open is heard.
"""

from __future__ import annotations

from components.base.pioneer.command import SYNC0, SYNC1, SYNC2, Command, integer, plain
from components.base.pioneer.config_pac import names_of
from components.base.pioneer.sip import is_sip

REST = (integer(Command.VEL, 0), integer(Command.RVEL, 0))
"""Before anything else: a robot whose watchdog has stopped it takes up its old speed again with the next packet."""
_STEPS = (SYNC0, SYNC1, SYNC2)
_PATIENCE_NS = 400_000_000
"""For an echo: SYNC2's has up to 60 bytes, 63 ms at 9600 baud."""
_TRIES = 3
_LISTEN_NS = 300_000_000
"""Three cycles of an open robot."""


class Handshake:
    """Says what to send until the robot has told its names."""

    def __init__(self, time_ns: int, listens: bool) -> None:
        """Nothing is sent yet.

        Args:
            time_ns: now.
            listens: first, instead of telling the robot to rest.
        """
        self._greeting = () if listens else REST
        self._step = 0
        self._tries = 0
        self._due_ns = time_ns + (_LISTEN_NS if listens else 0)
        self.names: tuple[str, str, str] | None = None
        """(name, class, subclass), at the end."""
        self.failed = False
        """Nobody has answered."""

    def take(self, payload: bytes, time_ns: int) -> tuple[bytes, ...]:
        """What to send after a packet of the robot."""
        if is_sip(payload):
            self._greeting = REST
            self._step = self._tries = 0
            self._due_ns = time_ns + _PATIENCE_NS
            return (*REST, plain(Command.CLOSE))
        if payload[0] != self._step or self.names is not None:
            return ()
        if self._step == len(_STEPS) - 1:
            self.names = names_of(payload)
            return ()
        self._step, self._tries, self._due_ns = self._step + 1, 0, time_ns
        return self.advance(time_ns)

    def advance(self, time_ns: int) -> tuple[bytes, ...]:
        """What to send because it is time."""
        if time_ns < self._due_ns or self.failed or self.names is not None:
            return ()
        if self._tries >= _TRIES:
            self.failed = True
            return ()
        self._tries += 1
        self._due_ns = time_ns + _PATIENCE_NS
        first = self._step == 0
        return (*self._greeting, _STEPS[0]) if first else (_STEPS[self._step],)
