"""What any camera answers to a request. Pure."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple


class Kind(Enum):
    """What it means for the request."""

    DONE = "done"
    POSITION = "position"
    BUSY = "busy"
    """Ask again."""
    UNREADY = "unready"
    """Not switched on, or not listening to us: begin anew."""
    REFUSED = "refused"
    NEWS = "news"
    """Of something that was asked before; answers nothing."""


class Reply(NamedTuple):
    """One answer."""

    kind: Kind
    pan: int = 0
    """With POSITION: the camera's own steps."""
    tilt: int = 0


class Request(NamedTuple):
    """Bytes for a camera, and how many its answer has if all goes well."""

    content: bytes
    answer_bytes: int
