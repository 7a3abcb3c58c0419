"""What one kind of robot means by its numbers. Pure. ARIA's parameter files; a turn is 4096 units exactly."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple


class Model(NamedTuple):
    """Factors of a subclass."""

    distance_mm: float = 1.0
    """One unit of x and y."""
    turn: float = 0.006
    """rad/s for 1 mm/s by which half the difference of the wheels is larger."""
    range_mm: float = 1.0
    """One unit of a sonar's range."""
    speed: float = 1.0
    """mm/s for one unit of a wheel's speed."""


TURN_UNIT_RAD = 2.0 * math.pi / 4096
"""One unit of the heading."""
DEFAULT = "peoplebot-sh"
MODELS: Mapping[str, Model] = {
    "peoplebot-sh": Model(),
    "p3dx-sh": Model(turn=0.0056),
    "p3dx": Model(distance_mm=0.485, turn=0.0056),
    "perfpb": Model(distance_mm=0.485),
    "perfpb+": Model(distance_mm=0.485),
    "p2pp": Model(distance_mm=0.485, range_mm=0.268),
    "p2pb": Model(distance_mm=0.424, range_mm=0.268, turn=0.0056),
}
"""By the subclass that the robot names in its handshake, in lower case."""
