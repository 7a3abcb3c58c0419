"""What is wrong with a robot on its first day: signs, units, swapped plugs, and clocks that lag. The default is right.

A scale is what comes out for what goes in: -1 = the wrong way round, 57.3 = degrees for radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from runtime.params import between, scale


@dataclass(frozen=True)
class Wiring:
    """Faults of the simulated robot, told to nobody: `--set simulator.wiring={pan=-1}`."""

    pan: float = scale()
    """True angle for the angle commanded."""
    tilt: float = scale()
    """As above."""
    pan_encoder: float = scale()
    """Angle read for the true one."""
    tilt_encoder: float = scale()
    """As above."""
    forward: float = scale()
    """True speed for the speed commanded."""
    turn: float = scale()
    """True turn rate for the one commanded."""
    odometry: float = scale()
    """Way and speed read for the true ones."""
    heading: float = scale()
    """Heading and turn rate read for the true ones."""
    lift_reversed: bool = False
    """The lift goes down when it is told to go up."""
    fingers_reversed: bool = False
    """The fingers open when they are told to close."""
    beams_swapped: bool = False
    """The inner beam's plug is in the outer one's socket."""
    inner_beam_inverted: bool = False
    """The beam plugged in as the inner one reads broken while it is whole."""
    outer_beam_inverted: bool = False
    """As above, for the outer one."""
    camera_latency_s: float = between(0.0, 0.0, 0.4)
    """An image shows the world of this long before its capture time."""
    encoder_latency_s: float = between(0.0, 0.0, 0.4)
    """As above, for pan and tilt."""

    def beams(self, inner: bool, outer: bool) -> tuple[bool, bool]:
        """(inner, outer) as they are read."""
        if self.beams_swapped:
            inner, outer = outer, inner
        return inner != self.inner_beam_inverted, outer != self.outer_beam_inverted

    def odometry_read(self, x_m: float, y_m: float, heading_rad: float) -> tuple[float, float, float]:
        """The true odometry as it is read. A heading that counts the wrong way mirrors y."""
        side = math.copysign(1.0, self.heading)
        return self.odometry * x_m, self.odometry * side * y_m, self.heading * heading_rad
