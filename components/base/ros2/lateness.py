"""How much later than the quickest ones a message came, by its stamp; the two clocks need not agree. Pure."""

from __future__ import annotations

_DRIFT = 500e-6
"""So fast a quick message is forgotten: clocks run apart, and nothing must seem late for that."""


_SET_NS = 60_000_000_000
"""No message is so late: the other clock was set."""


class Lateness:
    """Remembers the shortest way from the other clock to ours."""

    def __init__(self) -> None:
        self._shortest_ns: float | None = None
        self._at_ns = 0
        self._newest_ns: int | None = None

    def is_set_anew(self, stamp_ns: int, arrival_ns: int) -> bool:
        """Whether the other clock can not be the one that was known."""
        return self._shortest_ns is not None and abs(arrival_ns - stamp_ns - self._shortest_ns) > _SET_NS

    def late_s(self, stamp_ns: int, arrival_ns: int) -> float | None:
        """Seconds of lateness; None = an earlier or the same one was here already, or it is older than that.

        Args:
            stamp_ns: on the other clock; 0 = it has none, so nothing is known.
            arrival_ns: on ours, never decreasing.
        """
        if stamp_ns == 0:
            return 0.0
        if self._newest_ns is not None and stamp_ns <= self._newest_ns:
            return None
        self._newest_ns = stamp_ns
        way_ns = arrival_ns - stamp_ns
        shortest_ns = float(way_ns) if self._shortest_ns is None else self._shortest_ns
        shortest_ns = min(way_ns, shortest_ns + _DRIFT * (arrival_ns - self._at_ns))
        self._shortest_ns, self._at_ns = shortest_ns, arrival_ns
        return (way_ns - shortest_ns) * 1e-9
