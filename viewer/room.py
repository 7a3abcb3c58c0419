"""Lengths for the plan view, as far as a session tells them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from docking.plant import pose
from docking.task import Task
from runtime.recorded_launch import number_of
from schemas.percept_pb2 import Percept
from viewer.shown import Lines, Point

TABLE, STRIPE, CAN, GOAL = (216, 201, 174, 255), (242, 140, 40, 255), (46, 139, 87, 255), (26, 127, 55, 255)
_CAN_M, _ROBOT_M = 0.033, 0.18
_TABLE_M = (1.2, 0.8)
"""Half of its width, and its depth: the simulator's."""
_CORNERS = 24

Pose = tuple[float, float, float]
"""x, y, heading (rad)."""


@dataclass(frozen=True)
class Room:
    """The world from above. A session of a real robot knows no metre: there the unit is the camera's height."""

    task: Task
    height: float = 1.0
    """Of the camera above the object, in the plan's unit."""
    edge: float = 0.0
    """Of the table, this side of the object."""

    @staticmethod
    def of(launch: Mapping[str, Any], task: Task) -> Room:
        """The room of a resolved launch file."""
        return Room(task, number_of(launch, "camera_up_m", 1.0), number_of(launch, "edge_offset_m", 0.0))

    @property
    def unit(self) -> str:
        """What one step of the plan is."""
        return "camera heights" if self.height == 1.0 else "m"

    @property
    def goal(self) -> Pose:
        """Where the object can be picked up."""
        task = self.task
        return pose(task.goal_beta_rad, 0.0, self._distance(task.arrival_tilt_rad))

    def believed(self, percept: Percept) -> Pose | None:
        """Where a percept says the robot is; None if it says nothing."""
        angles = (percept.slope, percept.pan_rad, percept.tilt_rad)
        if not percept.visible or not all(map(math.isfinite, angles)):
            return None
        seen = self.task.seen(*angles)
        return pose(seen.beta_rad + self.task.goal_beta_rad, seen.alpha_rad, self._distance(seen.tilt_rad))

    def _distance(self, tilt_rad: float) -> float:
        return self.height / math.tan(max(tilt_rad, 1e-2))

    def robot(self, at: Pose) -> tuple[tuple[Point, ...], ...]:
        """Outline of the robot and the line ahead."""
        x, y, heading_rad = at
        radius = _ROBOT_M * self.height / 0.45
        nose = (x + 1.5 * radius * math.cos(heading_rad), y + 1.5 * radius * math.sin(heading_rad))
        return _circle(x, y, radius), ((x, y), nose)

    def furniture(self) -> dict[str, Lines]:
        """What stands still: table, edge, can, goal."""
        width, depth = (size * self.height / 0.45 for size in _TABLE_M)
        near, far = -self.edge, -self.edge + depth
        table = ((near, width), (far, width), (far, -width), (near, -width))
        return {
            "plan/table": Lines(((*table, table[0]),), TABLE, 2.0),
            "plan/edge": Lines((((near, width), (near, -width)),), STRIPE, 4.0),
            "plan/can": Lines((_circle(0.0, 0.0, _CAN_M * self.height / 0.45),), CAN, 4.0),
            "plan/goal": Lines(self.robot(self.goal), GOAL, 1.0),
        }


def _circle(x: float, y: float, radius: float) -> tuple[Point, ...]:
    turns = [2 * math.pi * corner / _CORNERS for corner in range(_CORNERS + 1)]
    return tuple((x + radius * math.cos(turn), y + radius * math.sin(turn)) for turn in turns)
