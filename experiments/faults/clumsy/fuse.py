"""A component that raises in the middle of a message, as one with a mistake in it would."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from runtime.contract import STOP, Event, Output


class Fused:
    """Stands before a component's class and fails for it."""

    def __init__(self, params: Any, seed: int) -> None:
        super().__init__(params, seed)  # type: ignore[call-arg]  # of the component that stands behind
        self._fuse = Path(params.fuse)

    def handle(self, event: Event) -> tuple[Output, ...]:
        """As the component, until the fuse is lit."""
        if event.port != STOP and self._fuse.is_file():
            raise ArithmeticError(f"a message on {event.port} that it can not digest")
        outputs: tuple[Output, ...] = super().handle(event)  # type: ignore[misc]
        return outputs
