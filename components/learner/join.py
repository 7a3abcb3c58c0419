"""Brings together what three components said about one frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

from components.learner.frame import Frame, Percept, Progress, command_of

_PARTS = 4


@dataclass
class Join:
    """Frames leave oldest first, once, when all their parts are there.

    An incomplete frame is given up when `patience` newer ones are complete; the buffer never holds more than 8 times
    that.
    """

    patience: int
    left_ns: int = -1
    """Newest frame that left or was given up; older parts are ignored."""
    waiting: dict[int, dict[str, Any]] = field(default_factory=dict)
    """By capture time: the parts so far."""

    def add(self, capture_ns: int, part: str, value: Percept | Progress | int | tuple[float, float]) -> None:
        """Remember a part: `percept`, `progress`, `action` or `command`."""
        if capture_ns <= self.left_ns:
            return
        self.waiting.setdefault(capture_ns, {})[part] = value
        if len(self.waiting) > 8 * self.patience:
            self._leave(min(self.waiting))

    def ready(self) -> Iterator[Frame]:
        """The frames that can leave now."""
        while self.waiting:
            oldest = min(self.waiting)
            parts = self.waiting[oldest]
            if len(parts) == _PARTS:
                self._leave(oldest)
                yield Frame(oldest, **parts)
            elif self._complete() >= self.patience:
                self._leave(oldest)
            else:
                return

    def to_plain(self) -> dict[str, Any]:
        """As JSON can say it."""
        return {"left_ns": self.left_ns, "waiting": sorted(self.waiting.items())}

    def from_plain(self, plain: dict[str, Any]) -> None:
        """Take over what `to_plain` gave.

        Raises:
            ValueError, TypeError, KeyError: it is nothing of the kind.
        """
        kinds: dict[str, Callable[[Any], Any]] = {
            "percept": lambda row: Percept(*row),
            "progress": lambda row: Progress(*row),
            "action": int,
            "command": command_of,
        }
        waiting = {int(ns): {name: kinds[name](part) for name, part in parts.items()} for ns, parts in plain["waiting"]}
        self.left_ns, self.waiting = int(plain["left_ns"]), waiting

    def _complete(self) -> int:
        return sum(len(parts) == _PARTS for parts in self.waiting.values())

    def _leave(self, capture_ns: int) -> None:
        del self.waiting[capture_ns]
        self.left_ns = capture_ns
