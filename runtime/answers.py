"""What a player waits for that stands in for components of a running lockstep system: the answers to each frame."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from threading import Lock

from runtime.launch import ComponentSpec, ports_of


@dataclass(frozen=True)
class Stand:
    """A key that is played in a component's place."""

    delayed: bool
    """The message is the world's next frame: it follows the answers to the frame before it."""
    waits_for: tuple[str, ...]
    """Keys of the running system that the component answers, once per frame."""


def stands(replaced: Collection[ComponentSpec], running: Collection[str]) -> dict[str, Stand]:
    """Key -> what it waits for, for every output port of the replaced components.

    Args:
        replaced: as the log's launch file has them.
        running: keys that the running system publishes itself.
    """
    return dict(stand for spec in replaced for stand in _of(spec, running))


def _of(spec: ComponentSpec, running: Collection[str]) -> Iterator[tuple[str, Stand]]:
    ports = ports_of(spec.run)
    for name, key in spec.outputs.items():
        output = ports.OUTPUTS[name]
        causes = [cause for cause in output.on if cause in spec.inputs and ports.INPUTS[cause].per_frame]
        yield key, Stand(output.delayed, tuple(spec.inputs[c] for c in causes if spec.inputs[c] in running))


class Answers:
    """The newest frame heard on each key, and the newest one shown."""

    def __init__(self, table: dict[str, Stand]) -> None:
        """Nothing was heard or shown."""
        self._stands = table
        self._heard: dict[str, int] = {}
        self._shown: list[int] = [-1, -1]
        """The last frame but one, and the last."""
        self._lock = Lock()

    @property
    def keys(self) -> set[str]:
        """What to listen to."""
        return {key for stand in self._stands.values() for key in stand.waits_for}

    def hear(self, key: str, capture_ns: int) -> None:
        """A message of the running system has come."""
        with self._lock:
            self._heard[key] = max(capture_ns, self._heard.get(key, -1))

    def missing(self, key: str, capture_ns: int) -> str:
        """The first key whose answer must come before a message may be played; empty = it may."""
        stand = self._stands.get(key)
        if stand is None:
            return ""
        needed_ns = capture_ns
        if stand.delayed:
            needed_ns = self._shown[1] if capture_ns > self._shown[1] else self._shown[0]
        with self._lock:
            return next((source for source in stand.waits_for if self._heard.get(source, -1) < needed_ns), "")

    def show(self, key: str, capture_ns: int) -> None:
        """A message was played."""
        stand = self._stands.get(key)
        if stand is not None and stand.delayed and capture_ns > self._shown[1]:
            self._shown = [self._shown[1], capture_ns]
