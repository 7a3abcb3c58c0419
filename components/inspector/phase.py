"""One step of a script: what the robot is told, and until when."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import NamedTuple

from components.inspector.sample import Sample

Until = Callable[[Sample, Sample], bool]
"""(first sample of the phase, newest sample) -> it is over."""
Choice = Callable[[Sequence[Sample]], int]
"""All samples so far -> what the gripper does."""


Check = Callable[[Sequence[Sample]], str]
"""All samples so far -> why the script must end here; empty = it may go on."""


class Action(IntEnum):
    """Numbers of `berth.GripperAction`."""

    KEEP = 0
    LOWER = 1
    CLOSE = 2
    LIFT = 3
    RELEASE = 4


class Phase(NamedTuple):
    """Told in every frame until `until` holds, or for `longest_s`."""

    name: str
    longest_s: float
    pan_rad: float = 0.0
    tilt_rad: float = 0.0
    v_mps: float = 0.0
    omega_radps: float = 0.0
    gripper: Action | Choice = Action.KEEP
    until: Until | None = None
    as_long_as: str = ""
    """Name of an earlier phase that took as many frames."""
    check: Check | None = None
    """Looked at when the phase is over."""
