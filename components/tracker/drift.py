"""How an angle of the line of sight changes per metre that the robot drives, filtered by filterpy."""

from __future__ import annotations

from dataclasses import dataclass

from filterpy.gh import GHFilter, critical_damping_parameters

SHORTEST_M = 0.002
"""Ways shorter than this show no drift above the encoder's resolution."""
LARGEST_RAD_PER_M = 5.0
"""The line of sight to a thing 0.2 m away turns by this at most."""

LARGEST_JUMP_RAD = 0.1
"""More than this between frames is no drift: the object or the robot was carried away."""


def smoother(memory: float) -> GHFilter:
    """The filter's gains.

    Args:
        memory: weight of an older measurement relative to the next newer one, 0..1.
    """
    return GHFilter(0.0, 0.0, 1.0, *critical_damping_parameters(memory))


@dataclass
class Drift:
    """A fading-memory filter of order 1 over the way driven: a g-h filter whose time is the way.

    The object rests, so the line of sight turns only as far as the robot drives: by sin(alpha)/d per metre. Unlike a
    rate per second this does not jump when the robot stops or reverses.
    """

    angle_rad: float = 0.0
    rad_per_m: float = 0.0
    """0 while unknown."""
    known: bool = False

    def update(self, angle_rad: float, way_m: float, smoother: GHFilter) -> None:
        """Take the angle measured after another `way_m`, the robot's own turns taken out.

        Args:
            angle_rad: measured.
            way_m: driven since the last measurement, signed.
            smoother: the gains; it keeps nothing.
        """
        if self.known and abs(angle_rad - self.angle_rad) > LARGEST_JUMP_RAD:
            self.forget()
        if not self.known or abs(way_m) < SHORTEST_M:
            self.angle_rad, self.known = angle_rad, True
            return
        smoother.x, smoother.dx, smoother.dt = self.angle_rad, self.rad_per_m, way_m
        angle, drift = smoother.update(angle_rad)
        self.angle_rad, self.rad_per_m = angle, min(max(drift, -LARGEST_RAD_PER_M), LARGEST_RAD_PER_M)

    def forget(self) -> None:
        """The object is out of sight."""
        self.rad_per_m, self.known = 0.0, False
