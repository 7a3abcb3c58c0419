"""What a player waits for that stands in for components of a running lockstep system: the answers to each frame."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from threading import Lock

from runtime.contract import ComponentError
from runtime.system import ComponentSpec, ports_of


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

    def __init__(self, table: dict[str, Stand], frames: Collection[str] = ()) -> None:
        """Nothing was heard or shown.

        Args:
            table: from `stands`.
            frames: keys on which the running system shows its own frames, if its world is not replaced.
        """
        self.stands = table
        self._frames = frames
        self._time_ns: int | None = None
        self._heard: dict[str, int] = {}
        self._shown: list[int] = [-1, -1]
        """The last frame but one, and the last."""
        self._lock = Lock()

    def reset(self) -> None:
        """A new epoch: nothing was heard or shown in it."""
        with self._lock:
            self._time_ns = None
            self._heard.clear()
        self._shown = [-1, -1]

    @property
    def keys(self) -> set[str]:
        """What to listen to."""
        return {key for stand in self.stands.values() for key in stand.waits_for}

    def hear(self, key: str, capture_ns: int) -> None:
        """A message of the running system has come."""
        with self._lock:
            self._heard[key] = max(capture_ns, self._heard.get(key, -1))

    def hear_time(self, capture_ns: int) -> None:
        """A component's status has come: the running system is at this frame, even if we came too late for it."""
        with self._lock:
            self._time_ns = max(capture_ns, self._time_ns or 0)
        for key in self._frames:
            self.hear(key, capture_ns)

    def missing(self, key: str, capture_ns: int) -> str:
        """The first key whose answer must come before a message may be played; empty = it may.

        Raises:
            ComponentError: the world's first frame lies before the running system's time.
        """
        stand = self.stands.get(key)
        if stand is None:
            return ""
        if stand.delayed and self._shown[1] < 0:
            return self._missing_time(capture_ns)
        needed_ns = capture_ns
        if stand.delayed:
            needed_ns = self._shown[1] if capture_ns > self._shown[1] else self._shown[0]
        with self._lock:
            return next((source for source in stand.waits_for if self._heard.get(source, -1) < needed_ns), "")

    def _missing_time(self, capture_ns: int) -> str:
        with self._lock:
            time_ns = self._time_ns
        if time_ns is not None and time_ns > capture_ns:
            raise ComponentError(
                f"the running system is at {time_ns / 1e9:.3f} s and can not go back to {capture_ns / 1e9:.3f} s; "
                "start it anew, or play from there (--start-offset)"
            )
        return "*/status" if time_ns is None else ""

    def show(self, key: str, capture_ns: int) -> None:
        """A message was played."""
        stand = self.stands.get(key)
        if stand is not None and stand.delayed and capture_ns > self._shown[1]:
            self._shown = [self._shown[1], capture_ns]
