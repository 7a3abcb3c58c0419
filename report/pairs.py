"""Joins two streams of messages by capture time."""

from __future__ import annotations

from typing import Generic, TypeVar

First = TypeVar("First")
Second = TypeVar("Second")

WINDOW = 64
"""Halves that may wait for their other; the oldest is dropped (a message was lost)."""


class Pairs(Generic[First, Second]):
    """Each half waits for the other of the same capture time."""

    def __init__(self) -> None:
        self._firsts: dict[int, First] = {}
        self._seconds: dict[int, Second] = {}

    def first(self, capture_ns: int, half: First) -> tuple[First, Second] | None:
        """Take a first half; returns the pair if it is complete."""
        other = self._seconds.pop(capture_ns, None)
        if other is not None:
            return half, other
        _keep(self._firsts, capture_ns, half)
        return None

    def second(self, capture_ns: int, half: Second) -> tuple[First, Second] | None:
        """Take a second half; returns the pair if it is complete."""
        other = self._firsts.pop(capture_ns, None)
        if other is not None:
            return other, half
        _keep(self._seconds, capture_ns, half)
        return None


Half = TypeVar("Half")


def _keep(waiting: dict[int, Half], capture_ns: int, half: Half) -> None:
    waiting[capture_ns] = half
    if len(waiting) > WINDOW:
        waiting.pop(next(iter(waiting)))
