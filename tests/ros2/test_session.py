"""`launch/ros2.toml` against the emulated base and pan-tilt camera, over zenoh, in real time."""

import math
import time

import pytest

from components.simulator.params import Params
from docking.score import DOCKED_M
from runtime.launch import load
from runtime.supervise import Supervisor
from schemas.trial_pb2 import Trial
from tests.driven import Driven
from tests.pioneer.cameras import Canon
from tests.pioneer.served import Serial
from tests.pioneer.session import DEADLINE_S, LAUNCH, NEAR, Showing, launch_file
from tests.ros2.served import Served

pytestmark = pytest.mark.xdist_group("session")
SETTINGS = ["pilot.train_s=0", "pilot.evaluation_trials=5", "pilot.evaluation_controller=lc"]


class WithCamera(Served):
    """A pan-tilt camera of its own stands on the robot, at a pseudo-terminal."""

    def __init__(self, start, **robot):
        super().__init__(Driven(Params(home_tilt_rad=0.0), start, 0), **robot)
        self.end = Serial()
        self.camera = Canon(lambda: self.body.head, inverted=True)

    def exchange(self, now_ns):
        super().exchange(now_ns)
        self.camera.hear(self.end.read(), now_ns)
        self.end.write(self.camera.speak(now_ns))


@pytest.fixture
def robot(tmp_path):
    with WithCamera(NEAR, bridge="rmw_zenoh", stamped=True, timeout_s=None) as served:
        showing = Showing(tmp_path / "eyes", served)
        yield served
        showing.close()
    served.end.close()


def test_a_turtlebot_that_wants_stamps_and_has_no_timeout_docks_over_rmw_zenoh(tmp_path, robot):
    replaced = {"/dev/ttyUSB0": robot.end.port, "tcp/127.0.0.1:7447": robot.endpoint,
                '"ros2dds", stamped = false': '"rmw_zenoh", stamped = true'}  # fmt: skip
    system = load(launch_file(tmp_path, LAUNCH.with_name("ros2.toml"), replaced), SETTINGS, recording=None)
    ended, errors_m = [], []

    def watch(trial, _time_ns):
        if trial.ended > len(ended):
            ended.append(trial.outcome)
            with robot.turn:
                errors_m.append(math.hypot(*robot.body.object_from_gripper))

    supervisor = Supervisor(system)
    supervisor.watch("pilot/trial", watch)
    deadline_s = time.monotonic() + DEADLINE_S
    with supervisor:
        while supervisor.poll(0.1) and Trial.ARRIVED not in ended:
            assert time.monotonic() < deadline_s, ended
    assert ended[-1] == Trial.ARRIVED, supervisor.end_reason
    assert errors_m[-1] <= DOCKED_M
    assert not robot.body.collided
    assert robot.v_mps == 0.0
    assert robot.robot.unheard == 0
