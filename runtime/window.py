"""The messages of one input port that wait for the journal to name them."""

from __future__ import annotations

from runtime.recording import Logged

_COUNT = 1024
"""A journal entry comes at most one batch and one full queue after its message; the longest of both together."""
_BYTES = 128 * 1024 * 1024
SEQUENCE_MASK = 0xFFFFFFFF
"""A recording keeps the low 32 bits of a sequence."""


class Window:
    """Bounded; messages of one run come in order, and what was passed over is never asked for again."""

    def __init__(self) -> None:
        self._waiting: dict[tuple[int, int], Logged] = {}
        self._bytes = 0
        self._newest: dict[int, int] = {}

    def add(self, logged: Logged) -> None:
        """One more message; the oldest give way."""
        self._waiting[logged.run, logged.sequence] = logged
        self._bytes += len(logged.payload)
        self._newest[logged.run] = logged.sequence
        while len(self._waiting) > _COUNT or self._bytes > _BYTES:
            self._drop_oldest()

    def take(self, run: int, sequence: int) -> Logged | None:
        """The message asked for, or None if it is not here; those before it are dropped."""
        key = (run, sequence & SEQUENCE_MASK)
        if key not in self._waiting:
            return None
        while True:
            oldest, logged = self._drop_oldest()
            if oldest == key:
                return logged

    def has_passed(self, run: int, sequence: int) -> bool:
        """Whether a message that is not here can not come any more: a later one of its run was here."""
        return self._newest.get(run, -1) >= sequence & SEQUENCE_MASK

    def _drop_oldest(self) -> tuple[tuple[int, int], Logged]:
        key = next(iter(self._waiting))
        logged = self._waiting.pop(key)
        self._bytes -= len(logged.payload)
        return key, logged
