"""Packets on their way to the robot: one at a time, no faster than it and the line can take them. Pure."""

from __future__ import annotations

from collections import deque

from components.base.pioneer.command import Command, integer
from components.base.pioneer.handshake import REST
from components.base.pioneer.setpoint import STILL, SetPoint

_GAP_NS = 5_000_000
"""A robot takes one command in 3 to 5 ms."""
_REFRESH_NS = 200_000_000
"""Set-points are said again after this: nobody acknowledges them, and the robot's watchdog wants a packet."""
_QUIET_NS = 450_000_000
"""After so long without a packet the robot may have stopped by itself, and would drive on with the next one."""
_MOST = 64
"""Packets that wait; more is a fault of ours, and the oldest are dropped."""
_BITS = 10
"""A byte on a serial line: start, eight, stop."""


class Outbox:
    """Set-points overtake everything but rest; of them only the newest counts."""

    def __init__(self) -> None:
        self._urgent: deque[bytes] = deque()
        self._others: deque[bytes] = deque(maxlen=_MOST)
        self._said: dict[Command, tuple[int, int]] = {}
        """Value and time of VEL and RVEL."""
        self._free_ns = 0
        self._sent_ns: int | None = None
        self.point = STILL
        """Wanted."""
        self.drives = False
        """Whether set-points are sent at all: the robot is open."""

    def add(self, packets: tuple[bytes, ...]) -> None:
        """Send these after what waits already."""
        self._others.extend(packets)

    def clear(self) -> None:
        """Begin anew, at rest, before a robot of which nothing is known."""
        self._urgent.clear()
        self._others.clear()
        self._said.clear()
        self.point, self.drives, self._sent_ns = STILL, False, None

    def next(self, time_ns: int, baud: int) -> bytes:
        """The packet to be written now; empty = none, or it is not its time."""
        if time_ns < self._free_ns:
            return b""
        if self._sent_ns is not None and time_ns - self._sent_ns > _QUIET_NS:
            self.point = STILL
            self._urgent.extend(REST)
            self._said = dict.fromkeys((Command.VEL, Command.RVEL), (0, time_ns))
        packet = self._chosen(time_ns)
        if packet:
            self._sent_ns = time_ns
            self._free_ns = time_ns + max(_GAP_NS, len(packet) * _BITS * 1_000_000_000 // baud)
        return packet

    @property
    def waits(self) -> bool:
        """Whether more is to be written soon."""
        return bool(self._urgent or self._others or self._changed())

    def _chosen(self, time_ns: int) -> bytes:
        if self._urgent:
            return self._urgent.popleft()
        due = self._changed() or self._stale(time_ns)
        if due is not None:
            self._said[due] = (self._value(due), time_ns)
            return integer(due, self._value(due))
        return self._others.popleft() if self._others else b""

    def _value(self, command: Command) -> int:
        point: SetPoint = self.point
        return point.speed_mmps if command == Command.VEL else point.turn_degps

    def _changed(self) -> Command | None:
        if not self.drives:
            return None
        motions = (Command.VEL, Command.RVEL)
        return next((c for c in motions if c not in self._said or self._said[c][0] != self._value(c)), None)

    def _stale(self, time_ns: int) -> Command | None:
        if not self.drives:
            return None
        return next((c for c, (_, said_ns) in self._said.items() if time_ns - said_ns >= _REFRESH_NS), None)
