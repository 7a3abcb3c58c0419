"""The simulator with a ROS 2 base between its wheels and base. Deterministic: no thread, no clock, no zenoh."""

from components.base.devices.ros2 import _state
from components.base.ports import Ros2
from components.base.ros2.client import Client
from tests.driven import Driven
from tests.driven_world import DrivenWorld
from tests.ros2.robot import BOOTED_NS, Robot
from tests.ros2.ros_world import ports

BY_ROS = ("odometry_x_m", "odometry_y_m", "odometry_heading_rad", "v_mps", "omega_radps", "bumper", "guard",
          "battery_v", "fault", "watchdog_s")  # fmt: skip


class RosWorld(DrivenWorld):
    """What base says goes through the client and the robot's codec; what it reads comes back the same way.

    The gripper, which no TurtleBot has, is the simulator's own and driven as ever.
    """

    Params = ports.Params
    World = Driven

    def born(self, world, time_ns):
        self._ros = Ros2(bridge=self._params.bridge, battery="battery_state", bumper="hazard_detection")
        self._client = Client(self._ros, "ab12", time_ns)
        self._robot = Robot(world, self._params.bridge)
        assert self._client.command_key == self._robot.command_key
        self._reading = None
        world.twist, world.before_step = self._robot.twist, self._exchange

    def _exchange(self, time_ns):
        client, robot = self._client, self._robot
        client.advance(time_ns)
        sample = client.sample(time_ns, BOOTED_NS + time_ns)
        if sample is not None:
            robot.hear(*sample, time_ns)
        for said in robot.speak(time_ns):
            client.take(said.key, said.payload, time_ns)
        while client.readings:
            self._reading = client.readings.popleft()

    def _take(self, world, event, arrival_ns):
        if event.port != "drive":
            super()._take(world, event, arrival_ns)
            return
        said = event.message
        self._client.command(said.v_mps, said.omega_radps, arrival_ns)
        world.gripper.command(said.gripper, said.lift_reversed, said.fingers_reversed)
        self._gate.answer(event.port, event.capture_ns)

    def told(self, world, said):
        if self._reading is None:
            return {}
        state, heard = said["base"], _state(self._reading, self._ros)
        for name in BY_ROS:
            setattr(state, name, getattr(heard, name))
        return {"base": state}
