"""Packets on the wire: FA FB, byte count, payload, checksum. Pure; any bytes whatever are good input.

Pioneer 2 / PeopleBot Operations Manual, "Communication packet protocol". There are no acknowledgements: a packet with
a wrong checksum is dropped silently, by either side.
"""

from __future__ import annotations

HEADER = b"\xfa\xfb"
SHORTEST, LONGEST = 3, 255
"""Byte counts: one byte of payload and the checksum; what a byte can say (robots send up to 207)."""
MOST_PAYLOAD = 198
"""Bytes that a robot accepts: P2OS reads a byte count of 200 at the most."""
_OVERHEAD = 3
"""Header and byte count."""


def checksum(payload: bytes) -> int:
    """Sum of the payload's big-endian pairs, modulo 65536; an odd last byte is XORed into it."""
    total = sum(payload[0:-1:2]) * 256 + sum(payload[1::2])
    return (total & 0xFFFF) ^ payload[-1] if len(payload) % 2 else total & 0xFFFF


def framed(payload: bytes) -> bytes:
    """The packet around a payload.

    Raises:
        ValueError: no robot would accept it.
    """
    if not 0 < len(payload) <= MOST_PAYLOAD:
        raise ValueError(f"payload must have 1 to {MOST_PAYLOAD} bytes; got {len(payload)}")
    return HEADER + bytes((len(payload) + 2,)) + payload + checksum(payload).to_bytes(2, "big")


class Frames:
    """Cuts a stream into payloads, however it is split, glued or spoiled.

    After anything that is no packet it goes on one byte later, so that no good packet is lost behind a bad one. It
    never holds more than one packet and what came with it.
    """

    def __init__(self) -> None:
        self._buffer = b""
        self.refused = 0
        """Headers that no packet followed."""

    def feed(self, data: bytes) -> list[bytes]:
        """The payloads that are complete."""
        self._buffer += data
        found, at = [], 0
        while (at := self._next_header(at)) >= 0:
            end = self._end(at)
            if end > len(self._buffer):
                break
            if self._is_packet(at, end):
                found.append(self._buffer[at + _OVERHEAD : end - 2])
                at = end
            else:
                self.refused += 1
                at += 1
        self._buffer = self._buffer[at:] if at >= 0 else b""
        return found

    def settle(self) -> list[bytes]:
        """Nothing has come for a while: a packet that is whole must not wait behind the length of a false header.

        The incomplete packet is kept unless a whole one lies within it: it may only have been split.
        """
        for at in range(1, len(self._buffer)):
            if self._buffer.startswith(HEADER, at):
                end = self._end(at)
                if end <= len(self._buffer) and self._is_packet(at, end):
                    self._buffer = self._buffer[at:]
                    self.refused += 1
                    return self.feed(b"")
        return []

    @property
    def waiting(self) -> int:
        """Bytes held."""
        return len(self._buffer)

    def _next_header(self, at: int) -> int:
        """Where the next header begins, or the last byte if it may be half of one; -1 = nowhere."""
        found = self._buffer.find(HEADER, at)
        if found < 0 and len(self._buffer) > at and self._buffer.endswith(HEADER[:1]):
            return len(self._buffer) - 1
        return found

    def _end(self, at: int) -> int:
        """Where the packet that begins here ends; beyond the buffer while its byte count has not come."""
        count_at = at + len(HEADER)
        return count_at + 1 + self._buffer[count_at] if count_at < len(self._buffer) else len(self._buffer) + 1

    def _is_packet(self, at: int, end: int) -> bool:
        payload, expected = self._buffer[at + _OVERHEAD : end - 2], self._buffer[end - 2 : end]
        if not SHORTEST <= end - at - _OVERHEAD <= LONGEST:
            return False
        return checksum(payload) == int.from_bytes(expected, "big")
