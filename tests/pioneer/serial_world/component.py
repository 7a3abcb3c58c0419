"""The simulator with a serial line at 9600 baud between base and the wheels. Deterministic: no thread, no clock."""

import numpy as np

from components.base.devices.pioneer import _state
from components.base.pioneer.client import Client, Wish
from components.base.ports import Pioneer
from components.simulator.beginning import first_start
from components.simulator.component import ODOMETRY_STREAM, Simulator
from tests.pioneer.body import Body
from tests.pioneer.robot import Robot

BAUD = 9600


class SerialWorld(Simulator):
    """What base says goes through the client, the line and the robot; what it reads comes back the same way."""

    def _begin(self, time_ns):
        body = Body(self._params, first_start(self._params, self._seed), time_ns)
        scales = np.random.default_rng([self._seed, 0, ODOMETRY_STREAM]).normal(1.0, self._params.odometry_scale, 2)
        body.odometry_scale = (float(scales[0]), float(scales[1]))
        self._client = Client(Pioneer(), time_ns)
        self._robot = Robot(body)
        self._reading = None
        body.twist, body.before_step = self._robot.twist, self._exchange
        self._world = body
        return self._frame(body)

    def _exchange(self, time_ns):
        client, robot = self._client, self._robot
        client.advance(time_ns)
        robot.hear(client.packet(time_ns, BAUD), time_ns)
        said = robot.speak(time_ns)
        if said:
            client.take(said, time_ns)
        if client.readings:
            self._reading = client.readings[-1]
            client.readings.clear()

    def _take(self, world, event, arrival_ns):
        if event.port != "drive":
            super()._take(world, event, arrival_ns)
            return
        said = event.message
        wish = Wish(said.v_mps, said.omega_radps, said.gripper, said.lift_reversed, said.fingers_reversed)
        self._client.command(wish, arrival_ns)
        self._gate.answer(event.port, event.capture_ns)

    def _frame(self, world):
        outputs = super()._frame(world)
        if self._reading is None:
            return outputs
        told = _state(self._reading)
        return tuple(output._replace(message=told) if output.port == "base" else output for output in outputs)
