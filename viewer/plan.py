"""The robot from above: where it is, where it thinks it is, and the way it came."""

from __future__ import annotations

import math

from schemas.percept_pb2 import Percept
from schemas.truth_pb2 import Truth
from viewer.room import Pose, Room
from viewer.shown import Colour, Lines, Shown

ROBOT, BELIEF = (31, 111, 235, 255), (150, 150, 160, 255)
TRAIL_S = 30.0
_JUMP = 0.3
"""Who is so much further on in the next frame was placed, or time was left out: no line is drawn."""


class Plan:
    """Follows one robot. Truth is drawn where there is some, belief beside it; else belief alone."""

    def __init__(self, room: Room) -> None:
        """Nobody is there yet."""
        self._room = room
        self._last: dict[str, Pose] = {}
        self._knows = False
        """Whether there is any truth."""

    def truth(self, message: Truth, capture_ns: int) -> list[Shown]:
        """Where the robot is."""
        at = (message.x_m, message.y_m, message.heading_rad)
        self._knows = True
        return self._moved("robot", at, ROBOT, capture_ns) if all(map(math.isfinite, at)) else []

    def percept(self, message: Percept, capture_ns: int) -> list[Shown]:
        """Where it thinks it is."""
        at = self._room.believed(message)
        name, colour = ("belief", BELIEF) if self._knows else ("robot", ROBOT)
        if at is None:
            self._last.pop(name, None)
            return [Shown(f"plan/{name}", capture_ns, Lines((), colour))]
        return self._moved(name, at, colour, capture_ns)

    def _moved(self, name: str, at: Pose, colour: Colour, capture_ns: int) -> list[Shown]:
        before = self._last.get(name, at)
        self._last[name] = at
        shown = [Shown(f"plan/{name}", capture_ns, Lines(self._room.robot(at), colour))]
        if 0.0 < math.dist(before[:2], at[:2]) < _JUMP:
            step = Lines(((before[:2], at[:2]),), colour, 1.5, TRAIL_S)
            shown.append(Shown(f"plan/{name}_trail", capture_ns, step))
        return shown
