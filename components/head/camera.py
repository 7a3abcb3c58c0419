"""One camera at one line: asks, moves, asks again; time is an argument. Pure.

One request is under way at a time. A position counts for the moment at which it was asked for, however late the answer
is. Between two positions the newest aim goes out, so that neither starves the other. A camera that was read where it
was told to be stands there until it is told to move on: nobody else moves it. One that has done so some times in a row
is taken to do so the next time: at its set speed, from when it was told to. So frames need not wait for answers. An
answer that says otherwise ends that.
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
_SLOW_NS = _NS // 8
"""A camera that takes longer for an answer is moved for no less than _SLACK_RAD: after each move its place is unknown
for the time of two answers."""
_SLACK_RAD = math.radians(1.5)
_SAY_NS = _NS // 20
"""Where it stands is said again after this."""
_SETTLE_NS = _NS // 20
"""For speeding up and braking on the way to a target."""
_NEAR = 2
"""Steps from where it was told to be."""
_TRUST = 3
"""Moves in a row that ended where they were told to."""
_BITS = 10
_BAUD = 9600


Steps = tuple[int, int]
"""(pan, tilt) of the camera."""


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
        self._target: Steps | None = None
        self._told: Steps | None = None
        self._still: Steps | None = None
        """Where it stands; None = unknown."""
        self._from: Steps | None = None
        """Where it stood before the newest move, until that has been seen to be over."""
        self._arrives_ns = self._said_ns = self._answer_ns = 0
        self._coming: Steps | None = None
        """Where it will stand at `_arrives_ns` unless it says otherwise."""
        self._kept = 0
        """Moves in a row that it has made as told."""
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
        self._doubt()

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
        if self._coming is not None and time_ns >= self._arrives_ns:
            self._say(self._coming, self._arrives_ns)
            self._still, self._coming = self._coming, None
        if self._still is not None and time_ns - self._said_ns >= _SAY_NS:
            self._say(self._still, time_ns)
        if self._open is not None or time_ns < self._due_ns:
            return None
        self._open = self._next(time_ns)
        self._asked_ns = self._heard_ns(time_ns, self._open)
        return self._open

    def _next(self, time_ns: int) -> Request:
        if self._setup:
            return self._setup[0]
        if self._target is not None and not self._moved and self._is_worth_a_move(self._target):
            return self._move(self._target, time_ns)
        self._moved = False
        return self._protocol.inquire()

    def _is_worth_a_move(self, target: Steps) -> bool:
        if self._told is None or self._answer_ns <= _SLOW_NS:
            return target != self._told
        return self._way_rad(self._told, target, 1.0, 1.0) >= _SLACK_RAD

    def _move(self, target: Steps, time_ns: int) -> Request:
        if self._still is not None:
            self._say(self._still, time_ns)
        self._from, self._still = self._still, None
        request = self._protocol.move(*target)
        self._arrives_ns = self._heard_ns(time_ns, request) + _SETTLE_NS
        if self._from is not None:
            params = self._params
            way_s = self._way_rad(self._from, target, params.pan_rate_radps, params.tilt_rate_radps)
            self._arrives_ns += round(way_s * _NS)
        self._coming = target if self._from is not None and self._kept >= _TRUST else None
        self._moved, self._told = True, target
        return request

    def _doubt(self) -> None:
        """Where it stands, and whether it does what it is told, is unknown."""
        self._still = self._from = self._coming = None
        self._kept = 0

    def _way_rad(self, from_: Steps, to: Steps, pan_rate: float, tilt_rate: float) -> float:
        """The longer one of both axes' ways, each over its rate."""
        pan, tilt = (axis.angle_rad(abs(a - b)) for axis, a, b in zip(self._axes, from_, to, strict=True))
        return max(pan / pan_rate, tilt / tilt_rate)

    @property
    def _axes(self) -> tuple[Scale, Scale]:
        return self._protocol.pan, self._protocol.tilt

    def _heard_ns(self, time_ns: int, request: Request) -> int:
        """When the camera has the whole request."""
        return time_ns + self._way_ns + len(request.content) * _BITS * _NS // _BAUD

    def _say(self, steps: Steps, time_ns: int) -> None:
        """Say where it was, later than what was said before."""
        if time_ns > self._said_ns:
            pan, tilt = (self._sign * axis.angle_rad(n) for axis, n in zip(self._axes, steps, strict=True))
            self._said_ns = time_ns
            self.readings.append(Reading(pan, tilt, time_ns))

    def _read(self, steps: Steps) -> None:
        """It was there when it was asked."""
        if self._asked_ns < self._arrives_ns:
            self._say(steps, self._asked_ns)
            return
        arrived = self._told is not None and max(abs(a - b) for a, b in zip(steps, self._told, strict=True)) <= _NEAR
        if arrived and self._from is not None and self._arrives_ns < self._asked_ns:
            self._say(steps, self._arrives_ns)
        self._say(steps, self._asked_ns)
        if not arrived:
            self._doubt()
            return
        self._kept += self._from is not None
        self._still, self._from, self._coming = steps, None, None

    def _understand(self, reply: Reply, time_ns: int) -> None:
        if self._open is None or reply.kind == Kind.NEWS or not self._answers(reply, self._open):
            return
        if not self._answering:
            self._answering = True
            self.words.append("the camera answers")
        open_, self._open, self._unanswered = self._open, None, 0
        self._answer_ns = time_ns - self._asked_ns
        if reply.kind == Kind.POSITION:
            self._read((reply.pan, reply.tilt))
        elif reply.kind == Kind.UNREADY:
            self.begin(time_ns)
            self._due_ns = time_ns + _AGAIN_NS
        elif reply.kind == Kind.BUSY:
            self._told, self._due_ns = None, time_ns + _AGAIN_NS
            self._doubt()
        elif self._setup and open_ is self._setup[0]:
            self._setup.popleft()

    def _answers(self, reply: Reply, request: Request) -> bool:
        """Whether it can be the answer to this; a late one to something else is none."""
        wants_position = request.content == self._protocol.inquire().content
        return (reply.kind == Kind.POSITION) == wants_position or reply.kind not in {Kind.POSITION, Kind.DONE}

    def _miss(self, time_ns: int) -> None:
        """No answer has come in time. One that still comes shall not be taken for that of the next request."""
        self._protocol.forget()
        self._open = self._told = None
        self._doubt()
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
