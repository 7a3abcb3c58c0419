"""A perfect plant around a pilot: percepts from the pose, poses from the drive. No camera, no base, no bus."""

import math
from typing import NamedTuple

from components.pilot.component import Pilot
from docking import plant
from docking.task import Task
from runtime.contract import Event
from schemas.drive_pb2 import BaseState, Drive
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.trial_pb2 import Trial

HEIGHT_M = 0.45
"""Of the camera above the object."""
PERIOD_NS = 125_000_000
DEG = math.pi / 180
TASK = Task(beta_cells=5, alpha_cells=5)
FAR = (0.4, 0.3, math.atan2(HEIGHT_M, 1.5))
AT_GOAL = (0.0, 0.0, Task().goal_tilt_rad)
"""(beta, alpha, tilt)."""
EXACT = Task(goal_tilt_rad=math.atan2(HEIGHT_M, 0.28), tilt_limit_rad=60 * DEG)
"""The goal as this plant shows it, which has no can with a nearer half."""


class Seen(NamedTuple):
    """One frame: what the robot was, and what the pilot said."""

    time_ns: int
    beta_rad: float
    alpha_rad: float
    d_m: float
    drive: Drive
    trial: Trial
    ended: bool

    @property
    def gripper_error_m(self):
        """Distance of the gripper, 0.28 m ahead of the axle, from the object."""
        heading = self.beta_rad - self.alpha_rad
        ahead = 0.28 * math.cos(heading) - self.d_m * math.cos(self.beta_rad)
        left = 0.28 * math.sin(heading) - self.d_m * math.sin(self.beta_rad)
        return math.hypot(ahead, left)

    @property
    def heading_error_rad(self):
        return abs(self.beta_rad - self.alpha_rad)


def percept(beta, alpha, tilt, visible=True):
    return Percept(visible=visible, slope=math.tan(beta) * math.sin(tilt), pan_rad=alpha, tilt_rad=tilt)


def frame(pilot, k, message, state=None):
    """Hand frame k to the pilot; returns (drive, trial, ended)."""
    time_ns = k * PERIOD_NS
    pilot.handle(Event(time_ns, "base", state or BaseState(), time_ns))
    said = {o.port: o.message for o in pilot.handle(Event(time_ns, "percept", message, time_ns))}
    return said["drive"], said["trial"], "end" in said


def drive(params, seed, start, frames, *, noise_deg=0.0, generator=None, starts=None, blind=()):
    """Closed loop. Yields a `Seen` per frame, until the pilot ends the session.

    Args:
        start: (beta_rad, alpha_rad, d_m) of the first frame.
        starts: number -> (beta, alpha, d), where a placement puts the robot.
        noise_deg: standard deviation of beta, alpha and tilt in the percept.
        blind: frames in which the object is not seen.
    """
    pilot, pose, motion = Pilot(params, seed), plant.pose(*start), (0.0, 0.0)
    for k in range(frames):
        beta, alpha, d = plant.observe(*pose)
        b, a, t = (0.0, 0.0, 0.0) if generator is None else generator.normal(0.0, noise_deg * DEG, 3)
        look = percept(beta + b, alpha + a, math.atan2(HEIGHT_M, d) + t, k not in blind and abs(alpha) < 100 * DEG)
        command, trial, ended = frame(pilot, k, look, BaseState(v_mps=motion[0], omega_radps=motion[1]))
        yield Seen(k * PERIOD_NS, beta, alpha, d, command, trial, ended)
        if ended:
            return
        motion = (command.v_mps, command.omega_radps) if command.engaged else (0.0, 0.0)
        pose = plant.pose(*starts(trial.start)) if trial.place else plant.advance(*pose, *motion, 0.125)


def policy(everywhere=0, **changes):
    table = {
        "version": 1, "beta_cells": 5, "alpha_cells": 5, "beta_range_rad": TASK.beta_range_rad,
        "alpha_range_rad": TASK.alpha_range_rad, "action": bytes([everywhere]) * 25, "value": [0.0] * 25,
        "action_v_mps": [0.1, 0.1], "action_omega_radps": [0.17, -0.17],
    }  # fmt: skip
    return Policy(**{**table, **changes})


def tell(pilot, port, message, k=0):
    return pilot.handle(Event(k * PERIOD_NS, port, message, k * PERIOD_NS))


def answers(pilot, frames, look=FAR):
    """(drive, trial) of each of these frames."""
    return [frame(pilot, k, percept(*look))[:2] for k in frames]
