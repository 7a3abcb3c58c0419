"""A task file: the fields of `[task]` that a goal consists of, as TOML."""

from __future__ import annotations

from collections.abc import Sequence

from docking.angles import DEG
from docking.showing import Showing
from docking.task import Task

FIELDS = (
    "goal_slope",
    "goal_pan_rad",
    "goal_tilt_rad",
    "goal_heading_rad",
    "tilt_limit_rad",
    "start_tilt_min_rad",
    "start_tilt_max_rad",
)
"""What depends on camera, gripper, table and object; the rest of the task is the launch file's."""


def task_text(task: Task, showing: Showing, source: Sequence[str] = ()) -> str:
    """The file's contents; read back, every number is the same to the last bit.

    Args:
        task: with the goal.
        showing: what the goal was taken from.
        source: where and when, one line each.
    """
    words = [*source, *showing_lines(showing), *offset_lines(task)]
    fields = [f"{name} = {getattr(task, name)!r}" for name in FIELDS]
    return "".join(f"{line}\n" for line in (*(f"# {word}" for word in words), *fields))


def showing_lines(showing: Showing) -> list[str]:
    """Mean and spread, for people."""
    mean, spread = showing.mean, showing.spread
    return [
        f"slope {mean.slope:8.4f}     +- {spread.slope:.4f}",
        f"pan   {mean.pan_rad / DEG:8.3f} deg +- {spread.pan_rad / DEG:.3f}",
        f"tilt  {mean.tilt_rad / DEG:8.3f} deg +- {spread.tilt_rad / DEG:.3f}",
        f"seen in {showing.seen} of {showing.frames} frames",
    ]


def offset_lines(task: Task) -> list[str]:
    """What the goal says about the camera, for people."""
    percent, yaw_deg = 100.0 * task.offset.left, task.offset.yaw_rad / DEG
    return [
        f"so the camera is {abs(percent):.1f} % of its height above the object {_side(percent)} of the robot's axis",
        f"and turned {abs(yaw_deg):.1f} deg to the {_side(yaw_deg)}",
    ]


def _side(left: float) -> str:
    return "left" if left > 0.0 else "right"
