"""The simulator with a serial line at 9600 baud between it and base and head. Deterministic: no thread, no clock."""

import math

import numpy as np

from components.base.devices.pioneer import _state
from components.base.pioneer.client import Client, Wish
from components.base.ports import Pioneer
from components.head.camera import Camera
from components.head.canon import Canon
from components.head.devices.pan_tilt import AUX_WAY_S
from components.head.ports import PanTilt
from components.simulator.world import SUBSTEP_NS
from schemas.head_pb2 import HeadState
from tests.driven_world import DrivenWorld
from tests.pioneer import cameras
from tests.pioneer.body import Body
from tests.pioneer.robot import Robot
from tests.pioneer.serial_world.line import Way

BAUD = 9600
TURNS = 3
"""Looks at the line in a step of the world, 5 ms each."""
_KEPT = 64


class SerialWorld(DrivenWorld):
    """What base says goes through the client, the line and the robot; what it reads comes back the same way.

    The camera hangs at the robot's auxiliary port. Its angles are known a moment late: of the moment that
    `wiring.encoder_latency_s` ago was, as the driver has come to know it.
    """

    World = Body

    def born(self, body, time_ns):
        inverted = self._params.wiring.tilt > 0.0
        self._client = Client(Pioneer(), time_ns)
        self._robot = Robot(body, {1: cameras.Canon(lambda: body.head, inverted=inverted)})
        self._driver = Camera(Canon(), PanTilt(inverted=True), time_ns, AUX_WAY_S)
        self._there, self._back = Way(BAUD), Way(BAUD)
        self._reading = None
        self._angles = []
        body.twist, body.before_step = self._twist, self._step_line

    def _twist(self, time_ns):
        """As the robot's wheels are wired."""
        v_mps, omega_radps = self._robot.twist(time_ns)
        return self._params.wiring.forward * v_mps, self._params.wiring.turn * omega_radps

    def _step_line(self, time_ns):
        for turn in range(TURNS):
            self._exchange(time_ns + turn * SUBSTEP_NS // TURNS)

    def _exchange(self, time_ns):
        client, robot, driver = self._client, self._robot, self._driver
        request = driver.request(time_ns)
        if request is not None and client.is_open:
            client.ask(*request)
        client.advance(time_ns)
        self._there.send(client.packet(time_ns, BAUD), time_ns)
        robot.hear(self._there.arrived(time_ns), time_ns)
        self._back.send(robot.speak(time_ns), time_ns)
        said = self._back.arrived(time_ns)
        if said:
            client.take(said, time_ns)
        while client.answers:
            driver.take(client.answers.popleft(), time_ns)
        if client.readings:
            self._reading = client.readings[-1]
            client.readings.clear()
        self._angles = [*self._angles, *driver.readings][-_KEPT:]
        driver.readings.clear()

    def _take(self, world, event, arrival_ns):
        said = event.message
        if event.port == "drive":
            wish = Wish(said.v_mps, said.omega_radps, said.gripper, said.lift_reversed, said.fingers_reversed)
            self._client.command(wish, arrival_ns)
        elif event.port == "aim":
            self._driver.aim(said.pan_rad, said.tilt_rad, said.pan_rate_radps, said.tilt_rate_radps)
        else:
            super()._take(world, event, arrival_ns)
            return
        self._gate.answer(event.port, event.capture_ns)

    def told(self, world, said):
        told = {"head": self._head(world.time_ns)}
        if self._reading is not None:
            told["base"] = _state(self._reading)
        return told

    def _head(self, time_ns):
        if not self._angles:
            return HeadState(pan_rad=math.nan, tilt_rad=math.nan)
        read_ns = time_ns - round(1e9 * self._params.wiring.encoder_latency_s)
        times, pans, tilts = zip(*((a.time_ns, a.pan_rad, a.tilt_rad) for a in self._angles), strict=True)
        return HeadState(pan_rad=np.interp(read_ns, times, pans), tilt_rad=np.interp(read_ns, times, tilts))
