"""The state of the simulated world, and one step of it."""

from __future__ import annotations

import math

import numpy as np

from components.simulator.base import Base, Pose
from components.simulator.gripper import Gripper
from components.simulator.head import Head
from components.simulator.params import SUBSTEPS_HZ, Params
from components.simulator.past import Moment, Past
from docking import plant
from docking.pinhole import Array, Camera, Mount
from docking.starts import Start

SUBSTEP_NS = 1_000_000_000 // SUBSTEPS_HZ
SUBSTEP_S = 1.0 / SUBSTEPS_HZ


class World:
    """Robot, table and object. Pure: time comes in, nothing is drawn from a generator here."""

    def __init__(self, params: Params, start: Start, time_ns: int) -> None:
        self._params = params
        self._mount = Mount(params.camera_forward_m, params.camera_left_m, params.camera_up_m, params.camera_yaw_rad)
        self.time_ns = time_ns
        self.base = Base(params, Pose(*plant.pose(*start)))
        self.head = Head(params)
        self.gripper = Gripper(params)
        self.odometry = Pose(0.0, 0.0, 0.0)
        self.odometry_scale = (1.0, 1.0)
        self.collided = False
        self.past = Past(params.wiring, SUBSTEPS_HZ)
        if params.begins == "fingertips":
            self.gripper.begin_lowered()

    def place(self, start: Start) -> None:
        """Carry the robot to a start: at rest, gripper raised and open, object on the table, head on the object.

        The head looks at the object so that every evaluation of a start begins alike, whatever came before.
        """
        self.base.place(Pose(*plant.pose(*start)))
        self.gripper = Gripper(self._params)
        camera = self.camera
        yaw_rad, tilt_rad = camera.towards(np.zeros(3))
        pan_rad = math.remainder(yaw_rad - camera.yaw_rad + self.head.pan.angle_rad, 2.0 * math.pi)
        self.head.look(pan_rad, tilt_rad)
        self.collided = False

    def step(self) -> None:
        """Advance 1/64 s."""
        self.base.step(self.time_ns, SUBSTEP_S)
        scale_v, scale_omega = self.odometry_scale
        self.odometry.move(scale_v * self.base.v_mps, scale_omega * self.base.omega_radps, SUBSTEP_S)
        self.collided = self.collided or self.base.bumper or self.base.rear_bumper
        self.time_ns += SUBSTEP_NS
        self.head.step(self.time_ns, SUBSTEP_S)
        self.gripper.step(*self.object_from_gripper, SUBSTEP_S)
        if self.past.is_kept:
            self.past.add(self.moment)

    @property
    def moment(self) -> Moment:
        """The world as it is now, for what sees it later."""
        return Moment(self.time_ns, *self.head.angles_rad, self.camera, self.object_m, self.image_motion_pxps)

    @property
    def object_from_gripper(self) -> tuple[float, float]:
        """(ahead_m, left_m) of the place for picking, the origin, seen from the gripper point."""
        x_m, y_m, heading_rad = self.base.pose.triple
        cos, sin = math.cos(heading_rad), math.sin(heading_rad)
        return -x_m * cos - y_m * sin - self._params.gripper_forward_m, x_m * sin - y_m * cos

    @property
    def object_m(self) -> Array:
        """Centre of the object, world `[3]`: at the origin, or in the gripper."""
        if not self.gripper.gripping:
            return np.zeros(3)
        x_m, y_m, heading_rad = self.base.pose.triple
        reach_m = self._params.gripper_forward_m
        return np.array(
            (
                x_m + reach_m * math.cos(heading_rad),
                y_m + reach_m * math.sin(heading_rad),
                self.gripper.lift * self._params.lift_height_m,
            )
        )

    @property
    def camera(self) -> Camera:
        """The camera as it is now."""
        return self._mount.camera(self.base.pose.triple, *self.head.angles_rad, self._params.scaled_focal_px)

    @property
    def image_motion_pxps(self) -> Array:
        """Velocity in the image, (u, v) `[2]`, of the point at the image centre that is as far away as the object."""
        camera, base, head = self.camera, self.base, self.head
        right, down, _ = camera.axes
        x_m, y_m, heading_rad = base.pose.triple
        ahead_m, aside_m = camera.x_m - x_m, camera.y_m - y_m
        velocity_mps = np.array(
            (
                base.v_mps * math.cos(heading_rad) - base.omega_radps * aside_m,
                base.v_mps * math.sin(heading_rad) + base.omega_radps * ahead_m,
                0.0,
            )
        )
        drift = velocity_mps / float(np.linalg.norm(self.object_m - camera.position))
        yaw_rate_radps = base.omega_radps + head.pan.rate_radps
        across = yaw_rate_radps * math.cos(camera.tilt_rad) - right @ drift
        return camera.focal_px * np.array((across, -head.tilt.rate_radps - down @ drift))
