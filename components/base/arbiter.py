"""Who commands in a frame: the first commander, by priority, whose command is fresh and engaged."""

from __future__ import annotations

from typing import NamedTuple

from components.base.motion import STILL, Motion

_MOST_FRAMES = 16
"""Frames that wait for an answer; the oldest is given up."""
NOBODY, STALE = "none", "stale"


class Wish(NamedTuple):
    """A commander's command for the frame captured at `capture_ns`."""

    engaged: bool
    motion: Motion
    capture_ns: int


class Decision(NamedTuple):
    """Who commands what; `capture_ns` is of the frame that the command answers."""

    commander: str
    motion: Motion
    capture_ns: int


class Arbiter:
    """Joins the answers of several commanders to one frame.

    Commanders that answer every frame are waited for; of the others the newest word counts. One of those who had the
    robot and fell silent keeps it, at rest, until he gives it back: a person's robot never drives off by itself.
    A frame is decided once, and no older one after it.
    """

    def __init__(
        self, priority: tuple[str, ...], awaited: tuple[str, ...], max_age_ns: int, begins_with: tuple[str, ...] = ()
    ) -> None:
        self._priority = priority
        self._unheard = set(begins_with)
        self._awaited = frozenset(awaited)
        self._max_age_ns = max_age_ns
        self._frames: dict[int, dict[str, Wish]] = {}
        self._arrived_ns: dict[int, int] = {}
        self._free: dict[str, Wish] = {}
        self.decided_ns = -1
        """Newest frame decided."""

    def is_awaited(self, commander: str) -> bool:
        """Whether this commander answers every frame."""
        return commander in self._awaited

    def hear(self, commander: str, wish: Wish, time_ns: int) -> None:
        """Take a command; one for a frame that is decided already changes nothing."""
        self._unheard.discard(commander)
        if not self.is_awaited(commander):
            newest = self._free.get(commander)
            if newest is None or wish.capture_ns >= newest.capture_ns:
                self._free[commander] = wish
        elif wish.capture_ns > self.decided_ns:
            self._frames.setdefault(wish.capture_ns, {}).setdefault(commander, wish)
            self._arrived_ns.setdefault(wish.capture_ns, time_ns)
            if len(self._frames) > _MOST_FRAMES:
                self._forget(min(self._frames))

    def decide(self, capture_ns: int, time_ns: int, *, wait: bool) -> Decision | None:
        """Decide a frame, or None if it is decided already or, with `wait`, an answer that matters is missing."""
        answers = self._frames.get(capture_ns)
        if answers is None:
            return None
        stale = False
        if self._unheard:
            return self._decided(capture_ns, Decision(NOBODY, STILL, capture_ns))
        for commander in self._priority:
            wish = answers.get(commander) if self.is_awaited(commander) else self._free.get(commander)
            if wish is None:
                if wait and self.is_awaited(commander):
                    return None
                continue
            if wish.engaged and time_ns - wish.capture_ns <= self._max_age_ns:
                return self._decided(capture_ns, Decision(commander, wish.motion, wish.capture_ns))
            if wish.engaged and not self.is_awaited(commander):
                return self._decided(capture_ns, Decision(STALE, STILL, capture_ns))
            stale = stale or wish.engaged
        return self._decided(capture_ns, Decision(STALE if stale else NOBODY, STILL, capture_ns))

    def overdue(self, time_ns: int, join_ns: int) -> int | None:
        """Newest frame that has waited longer than `join_ns` for an answer; None if there is none."""
        late = [frame for frame, arrived in self._arrived_ns.items() if time_ns - arrived >= join_ns]
        return max(late, default=None)

    def free(self, commander: str, time_ns: int) -> Decision | None:
        """What a commander that is not waited for wants at once; None if it is not engaged or not fresh."""
        wish = self._free.get(commander)
        if wish is None or not wish.engaged or time_ns - wish.capture_ns > self._max_age_ns:
            return None
        return Decision(commander, wish.motion, wish.capture_ns)

    def close(self, capture_ns: int) -> None:
        """Decide nothing any more about this frame and older ones."""
        self.decided_ns = max(self.decided_ns, capture_ns)
        for frame in [frame for frame in self._frames if frame <= capture_ns]:
            self._forget(frame)

    def _decided(self, capture_ns: int, decision: Decision) -> Decision:
        self.close(capture_ns)
        return decision

    def _forget(self, frame: int) -> None:
        del self._frames[frame]
        del self._arrived_ns[frame]
