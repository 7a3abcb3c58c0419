"""What a camera at another height would read: robots of a fleet are not built exactly alike."""

from __future__ import annotations

import math


def at_share(slope: float, tilt_rad: float, share: float) -> tuple[float, float]:
    """Slope and tilt (rad) as a camera reads them that is not `share` times as high over the object, but once.

    The way to the object stays: tan(tilt) is height over distance. Beta stays: slope = tan(beta) sin(tilt).
    """
    if share == 1.0 or tilt_rad <= 0.0:
        return slope, tilt_rad
    read_rad = math.atan2(math.sin(tilt_rad), share * math.cos(tilt_rad))
    return slope * math.sin(read_rad) / math.sin(tilt_rad), read_rad
