"""Keys of a terminal: bytes to readings. Pure; any bytes whatever are good input.

A terminal tells of pressing and repeating only, so a key counts for a moment (`hold_s`) and a held one repeats.
Every key that is not named here takes the robot and lets it rest.
"""

from __future__ import annotations

from components.teleop.core import Hand, Request

_ARCS = {
    (1.0, 1.0): ("q", "u"),
    (1.0, 0.0): ("w", "i", "\x1b[A", "\x1bOA"),
    (1.0, -1.0): ("e", "o"),
    (0.0, 1.0): ("a", "j", "\x1b[D", "\x1bOD"),
    (0.0, -1.0): ("d", "l", "\x1b[C", "\x1bOC"),
    (-1.0, -1.0): ("z", "m"),
    (-1.0, 0.0): ("s", ",", "\x1b[B", "\x1bOB"),
    (-1.0, 1.0): ("c", "."),
    (0.0, 0.0): (" ",),
}
_REQUESTS = {Request.GIVE: ("p",), Request.FASTER: ("+", "="), Request.SLOWER: ("-",)}
READINGS = {key.encode(): Hand(True, *arc) for arc, keys in _ARCS.items() for key in keys} | {
    key.encode(): Hand(request=request) for request, keys in _REQUESTS.items() for key in keys
}
"""Bytes of a key -> what it says."""
REST = Hand(request=Request.TAKE)
_ESCAPE = 0x1B
_LONGEST = 16
"""Bytes of an escape sequence; what is longer is none."""


class Keys:
    """Cuts a stream of bytes into keys; an escape sequence may come in parts."""

    def __init__(self) -> None:
        self._part = b""

    def feed(self, data: bytes) -> list[Hand]:
        """The readings that are complete."""
        found = []
        for value in data:
            self._part += bytes((value,))
            if self._is_whole():
                found.append(READINGS.get(self._part, REST))
                self._part = b""
        return found

    def flush(self) -> list[Hand]:
        """Nothing more came for a while: what is left was a key of its own (Escape)."""
        found = [REST] if self._part else []
        self._part = b""
        return found

    def _is_whole(self) -> bool:
        """Whether the bytes so far are a whole key: one byte, or ESC [ parameters letter, or ESC O letter."""
        part = self._part
        if part[0] != _ESCAPE or len(part) >= _LONGEST:
            return True
        if len(part) == 1 or part in {b"\x1b[", b"\x1bO"}:
            return False
        return part[1:2] not in {b"[", b"O"} or 0x40 <= part[-1] <= 0x7E
