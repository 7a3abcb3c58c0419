"""Robots that are not as they were built: what each does with a command, and where it sees the object. Vectorised."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from docking.actions import Actions
from docking.angles import DEG
from experiments.problem import GRIPPER_M

Floats = NDArray[np.float64]

HEIGHT_M = 0.45
"""Camera above the object, of the simulated robot. Only the robot knows it."""
HEAD_BEHIND_S = 0.2
"""By how much the head lags behind an object that moves steadily; the tracker's head needs less."""


@dataclass(frozen=True)
class Robot:
    """What a learner is not told."""

    speed_gain: float = 1.0
    """Speed executed per speed commanded: wheels that are larger or smaller than they were."""
    turn_gain: float = 1.0
    """Turn rate executed per turn rate commanded."""
    drift_radpm: float = 0.0
    """Turn per metre driven: wheels of unequal size."""
    delay_samples: float = 0.0
    """Sampling periods until a command is in force."""
    camera_left_m: float = 0.0
    """Camera beside the axis."""
    camera_yaw_rad: float = 0.0
    """Direction of the camera at pan 0; an error of the pan's zero is the same."""
    lead_s: float = 0.0
    """The percept runs ahead of the robot: the head lags behind the object, and the object's distance from the image's
    centre, which is added to the head's angles, is taken for larger than it is."""
    height_m: float = HEIGHT_M
    noise: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Standard deviation of beta, alpha (rad) and of d as a share of it."""

    def executed(self, commands: Floats) -> Floats:
        """Speed and turn rate `[N, 2]` of commands `[N, 2]`, m/s and rad/s."""
        v, omega = self.speed_gain * commands[:, 0], commands[:, 1]
        return np.stack([v, self.turn_gain * omega + self.drift_radpm * v], axis=1)

    def actions(self, commanded: Actions) -> Actions:
        """What the commands of an action set make of it: the actions of its ceiling."""
        executed = self.executed(np.array(commanded)).tolist()
        return tuple((v, omega) for v, omega in executed)

    def seen(self, poses: Floats) -> Floats:
        """Noise-free (beta rad, alpha rad, ln d) `[N, 3]` from poses `[N, 3]`; d in camera heights."""
        x, y, heading = poses.T
        camera_x, camera_y = x - self.camera_left_m * np.sin(heading), y + self.camera_left_m * np.cos(heading)
        beta = np.arctan2(-camera_y, -camera_x)
        alpha = wrapped(beta - heading - self.camera_yaw_rad)
        return np.stack([beta, alpha, np.log(np.hypot(camera_x, camera_y) / self.height_m)], axis=1)

    def percepts(self, poses: Floats, motions: Floats, rng: np.random.Generator) -> Floats:
        """As `seen`, relative to the goal's beta and alpha, with noise; in motion `[N, 2]`, m/s and rad/s."""
        found = self.seen(advanced(poses, motions, self.lead_s) if self.lead_s != 0.0 else poses)
        found[:, :2] -= self.goal[:2]
        if any(self.noise):
            found += rng.standard_normal(found.shape) * np.array(self.noise)
        return found

    @property
    def goal(self) -> Floats:
        """(beta, alpha, ln d) as it was shown: seen with the gripper at its pose."""
        return np.asarray(self.seen(np.array([[-GRIPPER_M, 0.0, 0.0]]))[0])


ROBOTS: Mapping[str, Robot] = {
    "as built": Robot(),
    "half turn rate": Robot(turn_gain=0.5),
    "unequal wheels": Robot(drift_radpm=0.1 / 0.4),  # 10 % of speed between wheels 0.4 m apart
    "150 ms delay": Robot(delay_samples=0.15 / 0.125),
    "pan zero off 3 deg": Robot(camera_yaw_rad=3 * DEG),
    "camera aside": Robot(camera_left_m=0.05, camera_yaw_rad=3 * DEG),
    "focal length x1.3": Robot(lead_s=0.3 * HEAD_BEHIND_S),
    "noisy percepts": Robot(noise=(2 * DEG, 1 * DEG, 0.05)),
}
"""By name. Percepts are angles of the head, so a focal length is only in what the head has not turned yet. This is the
robot whose tracker does not learn it, as the tracker of Berth does from its own head steps."""


def advanced(poses: Floats, motions: Floats, dt_s: float) -> Floats:
    """`docking.plant.advance` of many: poses `[N, 3]` after dt_s at speed and turn rate `[N, 2]`."""
    half = 0.5 * motions[:, 1] * dt_s
    chord = motions[:, 0] * dt_s * np.sinc(half / math.pi)
    along = poses[:, 2] + half
    return np.asarray(poses + np.stack([chord * np.cos(along), chord * np.sin(along), 2.0 * half], axis=1))


def states_of(poses: Floats) -> Floats:
    """`docking.plant.observe` of many: true (beta, alpha, d of the axle in m) `[N, 3]`."""
    x, y, heading = poses.T
    beta = np.arctan2(-y, -x)
    return np.stack([beta, wrapped(beta - heading), np.hypot(x, y)], axis=1)


def poses_of(states: Floats) -> Floats:
    """`docking.plant.pose` of many."""
    beta, alpha, d = states.T
    return np.stack([-d * np.cos(beta), -d * np.sin(beta), beta - alpha], axis=1)


def wrapped(angle: Floats) -> Floats:
    """The same angles in (-pi, pi]."""
    return np.asarray(math.pi - (math.pi - angle) % (2.0 * math.pi))


class Drivetrain:
    """Commands on their way to the wheels of `[N]` robots; before the first command they stand."""

    def __init__(self, robot: Robot, count: int) -> None:
        self.robot = robot
        self._whole = int(robot.delay_samples)
        self._share = robot.delay_samples - self._whole
        self._sent = [np.zeros((count, 2))] * (self._whole + 1)
        self.motions = np.zeros((count, 2))
        """Speed and turn rate of now, [count, 2]."""

    def drive(self, poses: Floats, commands: Floats, dt_s: float) -> Floats:
        """Poses after one sampling period, at whose begin the commands were sent."""
        self._sent.append(commands)
        older, newer = self._sent[-2 - self._whole], self._sent[-1 - self._whole]
        del self._sent[: -self._whole - 1]
        if self._share > 0.0:
            poses = advanced(poses, self.robot.executed(older), self._share * dt_s)
        self.motions = self.robot.executed(newer)
        return advanced(poses, self.motions, (1.0 - self._share) * dt_s)

    def keep(self, kept: NDArray[np.bool_]) -> None:
        """Forget the other robots."""
        self._sent = [commands[kept] for commands in self._sent]
        self.motions = self.motions[kept]
