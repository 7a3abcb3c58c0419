"""A fold that computes nothing: answers each frame once its inputs for that frame are there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from runtime.contract import Event, Output, Port


@dataclass(frozen=True)
class NoParams:
    """No parameters."""


class Relay:
    """Publishes every per-frame output when the per-frame inputs that cause it have come."""

    Params = NoParams
    inputs: ClassVar[Mapping[str, Any]]
    outputs: ClassVar[Mapping[str, Port]]

    def __init__(self, params: Any, seed: int) -> None:  # noqa: ARG002
        """Read the ports' declaration."""
        framed = {name for name, port in self.inputs.items() if isinstance(port, Port) and port.per_frame}
        self._causes = {name: framed & set(port.on) for name, port in self.outputs.items() if port.per_frame}
        self._seen: dict[int, set[str]] = {}

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Note the input; answer what it completes."""
        seen = self._seen.setdefault(event.capture_ns, set())
        seen.add(event.port)
        if len(self._seen) > 8:
            del self._seen[next(iter(self._seen))]
        ready = [name for name, causes in self._causes.items() if event.port in causes and causes <= seen]
        return tuple(Output(name, self.outputs[name].schema()) for name in ready)
