"""A serial line in emulated time: bytes arrive when their last bit has."""

from collections import deque

_NS = 1_000_000_000
_BITS = 10


class Way:
    """One direction."""

    def __init__(self, baud):
        self._byte_ns = _BITS * _NS // baud
        self._free_ns = 0
        self._parts = deque()

    def send(self, data, time_ns):
        if data:
            self._free_ns = max(self._free_ns, time_ns) + len(data) * self._byte_ns
            self._parts.append((self._free_ns, data))

    def arrived(self, time_ns):
        data = b""
        while self._parts and self._parts[0][0] <= time_ns:
            data += self._parts.popleft()[1]
        return data
