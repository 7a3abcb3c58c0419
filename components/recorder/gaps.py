"""Holes in sequences of messages."""

from __future__ import annotations


class Gaps:
    """Follows the sequence of each (key, run); a run is counted from its first message seen."""

    def __init__(self) -> None:
        self._next: dict[tuple[str, int], int] = {}
        self.lost = 0

    def missing(self, key: str, run: int, sequence: int) -> int:
        """How many messages are missing right before this one; messages out of order count as none."""
        expected = self._next.get((key, run), sequence)
        self._next[key, run] = max(expected, sequence + 1)
        hole = max(0, sequence - expected)
        self.lost += hole
        return hole
