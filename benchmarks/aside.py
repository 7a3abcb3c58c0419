"""A camera anywhere on a perfect robot before a perfect table: percepts by projection, no image, no noise, no delay.

Shows alone what the geometry of a taught goal is worth; `benchmarks/goal.py` has the whole robot.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from components.pilot.component import Pilot
from components.pilot.ports import Params
from docking import plant
from docking.angles import wrap
from docking.pinhole import Mount
from docking.score import DOCKED_M, DOCKED_RAD
from docking.showing import FEWEST_FRAMES, Percept, Showing
from docking.starts import start
from docking.task import Seen, Task
from runtime.contract import Event
from schemas.drive_pb2 import BaseState, Drive
from schemas.percept_pb2 import Percept as PerceptMessage
from schemas.trial_pb2 import Trial

GRIPPER_M, FRAME_S, LONGEST_FRAMES = 0.28, 0.125, 640
SEED = 2005
"""Of the starts: the simulator's list."""
Pose = tuple[float, float, float]
_OBJECT, _ALONG_EDGE = np.zeros(3), np.array((0.0, 1.0, 0.0))


class Subtracted(Task):
    """What taking the goal as the zero of slope and pan would do: right at the goal, wrong everywhere else."""

    @cached_property
    def arrival_tilt_rad(self) -> float:
        """Tilt at the goal."""
        return self.goal_tilt_rad

    def seen(self, slope: float, pan_rad: float, tilt_rad: float) -> Seen:
        """Differences from the goal."""
        goal_rad = self.beta(self.goal_slope, self.goal_tilt_rad)
        beta_rad, alpha_rad = self.beta(slope, tilt_rad) - goal_rad, pan_rad - self.goal_pan_rad
        return Seen(beta_rad, alpha_rad, tilt_rad, too_close=False)


def percept(mount: Mount, pose: Pose) -> Percept:
    """What a camera on this mount perceives that looks straight at the object."""
    idle = mount.camera(pose, 0.0, 0.0, 1.0)
    yaw_rad, tilt_rad = idle.towards(_OBJECT)
    pan_rad = wrap(yaw_rad - idle.yaw_rad)
    slope = mount.camera(pose, pan_rad, tilt_rad, 1.0).slope(_OBJECT, _ALONG_EDGE)
    return Percept(True, slope, pan_rad, tilt_rad)


def taught(mount: Mount) -> Task:
    """Task whose goal was shown to this camera."""
    return Showing.of([percept(mount, plant.pose(0.0, 0.0, GRIPPER_M))] * FEWEST_FRAMES).task(Task())


def docks(mount: Mount, task: Task, gains: tuple[float, float], number: int) -> bool:
    """Whether the linear law docks from start `number` of the demonstration's."""
    k_beta, k_alpha = gains
    pilot = Pilot(
        Params(
            task=task,
            train_s=0.0,
            evaluation_trials=1,
            evaluation_controller="lc",
            pick_up=False,
            k_beta_per_s=k_beta,
            k_alpha_per_s=k_alpha,
        ),
        0,
    )
    pose, drive = plant.pose(*start("demo", SEED, number, Task())), Drive()
    for frame in range(1, LONGEST_FRAMES):
        drive, trial = _answer(pilot, frame, percept(mount, pose), drive)
        if trial.ended or trial.phase == Trial.FINISHED:
            break
        pose = plant.advance(*pose, drive.v_mps, drive.omega_radps, FRAME_S)
    x_m, y_m, heading_rad = pose
    off_m = math.hypot(x_m + GRIPPER_M * math.cos(heading_rad), y_m + GRIPPER_M * math.sin(heading_rad))
    return off_m <= DOCKED_M and abs(wrap(heading_rad)) <= DOCKED_RAD


def _answer(pilot: Pilot, frame: int, seen: Percept, drive: Drive) -> tuple[Drive, Trial]:
    time_ns = round(frame * FRAME_S * 1e9)
    state = BaseState(v_mps=drive.v_mps, omega_radps=drive.omega_radps)
    pilot.handle(Event(time_ns, "base", state, time_ns))
    message = PerceptMessage(visible=True, slope=seen.slope, pan_rad=seen.pan_rad, tilt_rad=seen.tilt_rad)
    said = {output.port: output.message for output in pilot.handle(Event(time_ns, "percept", message, time_ns))}
    return said["drive"], said["trial"]
