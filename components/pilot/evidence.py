"""What a trial leaves behind that can explain its failure: plain numbers, saved with the pilot's progress."""

from __future__ import annotations

from dataclasses import dataclass, field

from runtime.params import between, not_negative


@dataclass(frozen=True, slots=True)
class Anchor:
    """Where the robot was when a comparison of wheels and view began."""

    time_ns: int = -1
    """-1 = none has begun."""
    odometry_x_m: float = 0.0
    odometry_y_m: float = 0.0
    odometry_heading_rad: float = 0.0
    seen_x: float = 0.0
    """Place before the table as the view has it, in camera heights above the object."""
    seen_y: float = 0.0
    seen_heading_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class Evidence:
    """Of one trial. Times are capture times in ns, -1 = not seen."""

    slip_ns: int = -1
    """Newest comparison in which the view did not move as the wheels did."""
    lock_ns: int = -1
    """Since when the linear law has asked for more than the turn limit, and the robot has turned that way at it."""
    promise: int = between(-1, -1, 1)
    """Whether the policy's value in the first cell that it acted in promised the goal; -1 = it has not acted."""
    anchor: Anchor = field(default_factory=Anchor)


@dataclass(frozen=True, slots=True)
class Forecast:
    """What the policy expects of a trial before the robot moves (`components.pilot.forecast`)."""

    share: float = between(0.0, 0.0, 1.0)
    """Probability that it docks; 0 = nothing was forecast."""
    time_s: float = not_negative(0.0)
    """Until then, if it does; 0 = it hardly will."""
    back_off_m: float = not_negative(0.0)
    """Straight back by so much it probably would; 0 = it will already, or no such way is known."""


@dataclass(frozen=True, slots=True)
class Scale:
    """How far the view moves for a metre of the wheels: one over the camera's height above the object, as experienced.

    It is learned over the whole session, so that no length need be told.
    """

    per_m: float = not_negative(0.0)
    comparisons: int = not_negative(0)
