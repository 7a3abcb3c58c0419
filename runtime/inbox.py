"""The inbox of a process: readers' threads put samples in, one thread takes them out."""

from __future__ import annotations

from collections import deque
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Condition
from typing import Any, NamedTuple

from runtime.wire import Stamp

BLOCK_S = 5.0
"""Lockstep: how long a full queue holds its publisher back before the sample counts as lost; below zenoh's lease."""


class Arrival(NamedTuple):
    """What a reader's thread leaves for the one thread that calls `handle`."""

    box: Box
    key: str
    schema: str
    payload: bytes
    stamp: Stamp


class Notice(NamedTuple):
    """Something that the shell itself has to say, e.g. that a peer is gone."""

    port: str
    message: Any = None


class Box:
    """The samples of one port that wait."""

    def __init__(self, name: str, limit: int, *, latest: bool, block: bool) -> None:
        """Make an empty box.

        Args:
            name: input port.
            limit: samples it holds.
            latest: a newer sample replaces the waiting one, which counts as skipped.
            block: a full box makes the publisher wait; else the sample is dropped and counts as lost.
        """
        self.name = name
        self.latest = latest
        self.block = block
        self.skipped = 0
        self.dropped = 0
        self.limit = limit
        self._waiting: deque[Arrival] = deque()
        self._changed = Condition()
        self._blocked = 0

    def put(self, sample: Arrival, block_s: float = BLOCK_S) -> bool:
        """Leave a sample; from a reader's thread.

        Returns:
            Whether one more sample waits than before.
        """
        with self._changed:
            if self.latest and self._waiting:
                self._waiting[0] = sample
                self.skipped += 1
                return False
            if len(self._waiting) >= self.limit and not (self.block and self._room(block_s)):
                self.dropped += 1
                return False
            self._waiting.append(sample)
            return True

    def _room(self, block_s: float) -> bool:
        """Wait until there is room, with the lock held."""
        self._blocked += 1
        try:
            return (
                self._changed.wait_for(lambda: len(self._waiting) < self.limit or not self.block, block_s)
                and self.block
            )
        finally:
            self._blocked -= 1

    def pop(self) -> Arrival:
        """Take the oldest sample; only after `put` has returned True once more than this was called."""
        with self._changed:
            sample = self._waiting.popleft()
            if self._blocked:
                self._changed.notify()
            return sample

    def shut(self) -> None:
        """Take nothing more and let go of whoever is blocked, for the end of a run."""
        with self._changed:
            self.block = False
            self.limit = 0
            self._changed.notify_all()


class Inbox:
    """All boxes of a process, in one order of arrival."""

    def __init__(self) -> None:
        """Nothing waits."""
        self._order: SimpleQueue[Box | Notice] = SimpleQueue()
        self._bell: SimpleQueue[None] = SimpleQueue()
        self.boxes: list[Box] = []

    def box(self, name: str, limit: int, *, latest: bool = False, block: bool = False) -> Box:
        """Make the box of one more port."""
        made = Box(name, limit, latest=latest, block=block)
        self.boxes.append(made)
        return made

    def put(self, sample: Arrival) -> None:
        """Leave a sample; from a reader's thread."""
        if sample.box.put(sample):
            self._order.put(sample.box)

    def notify(self, notice: Notice) -> None:
        """Leave a notice; from any thread, and from a signal handler."""
        self._order.put(notice)
        self._bell.put(None)

    def wait(self, timeout_s: float) -> None:
        """Wait for a notice, not for samples: whoever brings a sample sees to it that it is taken."""
        with suppress(Empty):
            self._bell.get(timeout=timeout_s)

    @property
    def is_empty(self) -> bool:
        """Whether nothing waits."""
        return self._order.empty()

    def take(self, timeout_s: float) -> Arrival | Notice | None:
        """The next sample or notice, or None if nothing came in time."""
        try:
            entry = self._order.get(timeout=timeout_s) if timeout_s > 0 else self._order.get_nowait()
        except Empty:
            return None
        return entry.pop() if isinstance(entry, Box) else entry

    def hold_back(self) -> None:
        """From now on full boxes make their publishers wait: there is somebody who takes."""
        for box in self.boxes:
            box.block = not box.latest

    def shut(self) -> None:
        """Take nothing more and let go of whoever is blocked, for the end of a run."""
        for box in self.boxes:
            box.shut()
