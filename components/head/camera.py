"""One camera at one line: asks, moves, asks again; time is an argument. Pure.

One request is under way at a time. A position counts for the moment at which it was asked for, however late the answer
is. Between two positions the newest aim goes out, so that neither starves the other.
"""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple, Protocol

from components.head.angles import Scale
from components.head.ports import PanTilt
from components.head.reply import Kind, Reply, Request

_NS = 1_000_000_000
_AGAIN_NS = _NS // 10
"""After a busy answer."""
_PATIENCE = 3
"""Requests without an answer after which the camera is gone."""
_BITS = 10
_BAUD = 9600


class Speech(Protocol):
    """How a camera is spoken to."""

    pan: Scale
    tilt: Scale

    def setup(self, pan_rate_radps: float, tilt_rate_radps: float) -> tuple[Request, ...]: ...  # noqa: D102
    def move(self, pan: int, tilt: int) -> Request: ...  # noqa: D102
    def inquire(self) -> Request: ...  # noqa: D102
    def forget(self) -> None: ...  # noqa: D102
    def feed(self, data: bytes) -> list[Reply]: ...  # noqa: D102


class Reading(NamedTuple):
    """Angles of the robot's own axes (left, down), and when they were; NaN = unknown."""

    pan_rad: float
    tilt_rad: float
    time_ns: int


class Camera:
    """See the module."""

    def __init__(self, protocol: Speech, params: PanTilt, time_ns: int, way_s: float = 0.0) -> None:
        """Nothing is sent yet.

        Args:
            protocol: how it is spoken to.
            params: of the launch file.
            time_ns: now.
            way_s: a request is on its way for so long, beside its own bytes.
        """
        self._way_ns = round(way_s * _NS)
        self._protocol = protocol
        self._params = params
        self._sign = 1.0 if params.inverted else -1.0
        self._target: tuple[int, int] | None = None
        self._told: tuple[int, int] | None = None
        self.readings: deque[Reading] = deque(maxlen=8)
        self.words: deque[str] = deque(maxlen=8)
        self._answering = False
        self.begin(time_ns)

    def begin(self, time_ns: int) -> None:
        """The line is open, and nothing is known of the camera."""
        self._protocol.forget()
        self._setup = deque(self._protocol.setup(self._params.pan_rate_radps, self._params.tilt_rate_radps))
        self._open: Request | None = None
        """Under way."""
        self._asked_ns = self._due_ns = time_ns
        self._unanswered = 0
        self._told = None
        self._moved = False

    def aim(self, pan_rad: float, tilt_rad: float, pan_rate_radps: float, tilt_rate_radps: float) -> None:
        """Look there, `lead_s` ahead."""
        lead_s = self._params.lead_s
        pan, tilt = pan_rad + lead_s * pan_rate_radps, tilt_rad + lead_s * tilt_rate_radps
        if math.isfinite(pan) and math.isfinite(tilt):
            self._target = self._protocol.pan.steps(self._sign * pan), self._protocol.tilt.steps(self._sign * tilt)

    def take(self, data: bytes, time_ns: int) -> None:
        """Bytes of the camera."""
        for reply in self._protocol.feed(data):
            self._understand(reply, time_ns)

    def request(self, time_ns: int) -> Request | None:
        """What to send now; None = nothing."""
        if self._open is not None and time_ns >= self._asked_ns + round(self._params.answer_s * _NS):
            self._miss(time_ns)
        if self._open is not None or time_ns < self._due_ns:
            return None
        self._open = self._next()
        self._asked_ns = time_ns + self._way_ns + len(self._open.content) * _BITS * _NS // _BAUD
        return self._open

    def _next(self) -> Request:
        if self._setup:
            return self._setup[0]
        if self._target is not None and self._target != self._told and not self._moved:
            self._moved, self._told = True, self._target
            return self._protocol.move(*self._target)
        self._moved = False
        return self._protocol.inquire()

    def _understand(self, reply: Reply, time_ns: int) -> None:
        if self._open is None or reply.kind == Kind.NEWS or not self._answers(reply, self._open):
            return
        if not self._answering:
            self._answering = True
            self.words.append("the camera answers")
        open_, self._open, self._unanswered = self._open, None, 0
        if reply.kind == Kind.POSITION:
            pan, tilt = self._protocol.pan.angle_rad(reply.pan), self._protocol.tilt.angle_rad(reply.tilt)
            self.readings.append(Reading(self._sign * pan, self._sign * tilt, self._asked_ns))
        elif reply.kind == Kind.UNREADY:
            self.begin(time_ns)
            self._due_ns = time_ns + _AGAIN_NS
        elif reply.kind == Kind.BUSY:
            self._told, self._due_ns = None, time_ns + _AGAIN_NS
        elif self._setup and open_ is self._setup[0]:
            self._setup.popleft()

    def _answers(self, reply: Reply, request: Request) -> bool:
        """Whether it can be the answer to this; a late one to something else is none."""
        wants_position = request.content == self._protocol.inquire().content
        return (reply.kind == Kind.POSITION) == wants_position or reply.kind not in {Kind.POSITION, Kind.DONE}

    def _miss(self, time_ns: int) -> None:
        """No answer has come in time. One that still comes shall not be taken for that of the next request."""
        self._protocol.forget()
        self._open, self._told = None, None
        self._due_ns = time_ns + round(self._params.answer_s * _NS)
        self._unanswered += 1
        if self._unanswered < _PATIENCE:
            return
        if self._answering:
            self.words.append("the camera does not answer; asking again and again")
        self._answering = False
        due_ns = self._due_ns
        self.begin(time_ns)
        self._due_ns = due_ns
        self.readings.append(Reading(math.nan, math.nan, time_ns))
