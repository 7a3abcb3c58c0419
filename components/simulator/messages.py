"""The messages of one frame: what camera, encoders, base and the all-knowing observer say about the world."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from components.simulator.paint import Painter
from components.simulator.params import Params
from components.simulator.sensor import Sensor
from components.simulator.world import World
from docking import plant
from runtime.contract import Output
from schemas.drive_pb2 import BaseState
from schemas.head_pb2 import HeadState
from schemas.image_pb2 import CompressedImage
from schemas.truth_pb2 import Truth

FRAME_STREAM = 3
"""Tag of the frames' generators, apart from those of starts, noise field and odometry."""


class Placing(NamedTuple):
    """Which start the robot was last placed at, and whether since the last frame."""

    start: int
    placed: bool


class Reporter:
    """Turns the world into messages. All chance of frame k comes from a generator of (seed, k)."""

    def __init__(self, params: Params, seed: int) -> None:
        self._params = params
        self._seed = seed
        self._painter = Painter(params)
        self._sensor = Sensor(params, seed)
        self._wiring = params.wiring

    def frame(self, world: World, number: int, placing: Placing) -> tuple[Output, ...]:
        """Image, encoders, base and truth, each stamped with the world's time."""
        chance = np.random.default_rng([self._seed, number, FRAME_STREAM])
        now_ns = world.time_ns
        return (
            Output("image", self._image(world, chance), now_ns),
            Output("head", self._head(world, chance), now_ns),
            Output("base", self._base(world, chance), now_ns),
            Output("truth", self._truth(world, placing), now_ns),
        )

    def _image(self, world: World, chance: np.random.Generator) -> CompressedImage:
        seen = world.past.seen(world.moment)
        clean = self._painter.image(seen.camera, seen.object_m)
        image = CompressedImage(frame_id="camera", format="jpeg")
        image.data = self._sensor.expose(clean, self._params.exposure_s * seen.motion_pxps, chance)
        image.timestamp.FromNanoseconds(world.time_ns)
        return image

    def _head(self, world: World, chance: np.random.Generator) -> HeadState:
        pan_rad, tilt_rad = (self._encoder(angle, chance) for angle in world.past.read(world.moment))
        return HeadState(pan_rad=self._wiring.pan_encoder * pan_rad, tilt_rad=self._wiring.tilt_encoder * tilt_rad)

    def _encoder(self, angle_rad: float, chance: np.random.Generator) -> float:
        reading = angle_rad + self._params.encoder_noise_rad * float(chance.standard_normal())
        step = self._params.encoder_step_rad
        return round(reading / step) * step if step > 0.0 else reading

    def _base(self, world: World, chance: np.random.Generator) -> BaseState:
        noise_v, noise_omega = (float(value) for value in chance.standard_normal(2))
        base, gripper, wiring = world.base, world.gripper, self._wiring
        x_m, y_m, heading_rad = wiring.odometry_read(*world.odometry.triple)
        inner, outer = wiring.beams(*gripper.beams(*world.object_from_gripper))
        return BaseState(
            odometry_x_m=x_m,
            odometry_y_m=y_m,
            odometry_heading_rad=heading_rad,
            v_mps=wiring.odometry * (base.v_mps + self._params.speed_noise_mps * noise_v),
            omega_radps=wiring.heading * (base.omega_radps + self._params.turn_noise_radps * noise_omega),
            bumper=base.bumper,
            inner_beam=inner,
            outer_beam=outer,
            lift_up=gripper.up,
            lift_down=gripper.down,
            fingers_closed=gripper.closed,
            rear_range_m=base.rear_range_m,
            rear_bumper=base.rear_bumper,
        )

    def _truth(self, world: World, placing: Placing) -> Truth:
        pose = world.base.pose.triple
        beta_rad, alpha_rad, d_axle_m = plant.observe(*pose)
        ahead_m, left_m = world.object_from_gripper
        pan_rad, tilt_rad = world.head.angles_rad
        object_px = world.camera.project(world.object_m[None])[0]
        return Truth(
            x_m=pose[0],
            y_m=pose[1],
            heading_rad=math.remainder(pose[2], 2.0 * math.pi),
            v_mps=world.base.v_mps,
            omega_radps=world.base.omega_radps,
            beta_rad=beta_rad,
            alpha_rad=alpha_rad,
            d_axle_m=d_axle_m,
            gripper_lateral_m=-left_m,
            gripper_longitudinal_m=-ahead_m,
            collided=world.collided,
            holding=world.gripper.holding,
            pan_rad=pan_rad,
            tilt_rad=tilt_rad,
            object_u_px=float(object_px[0]),
            object_v_px=float(object_px[1]),
            start=placing.start,
            placed=placing.placed,
        )
