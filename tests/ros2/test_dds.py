"""A DDS participant of Cyclone DDS, in a process of its own, is driven by the device.

Between them stands no zenoh-bridge-ros2dds (it is built with cargo), but what it does, for two topics.
"""

import os
import secrets
import subprocess
import sys

import pytest
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from components.base.devices import ros2
from components.base.ports import Ros2
from runtime.bus import free_endpoint, open_router
from tests.ros2 import dds_robot
from tests.ros2.messages import Odometry, Twist
from tests.wheel import Wheel

pytestmark = pytest.mark.xdist_group("live")
DEADLINE_S = 30.0


class Bridge:
    """Hands samples over from zenoh to DDS as they come, and back when it is asked to."""

    def __init__(self, domain):
        self.endpoint = free_endpoint()
        participant = DomainParticipant(domain)
        self._reader = DataReader(participant, Topic(participant, "rt/odom", Odometry))
        self._writer = DataWriter(participant, Topic(participant, "rt/cmd_vel", Twist))
        self._session = open_router(self.endpoint)
        self._session.declare_subscriber("cmd_vel", self._to_dds)

    def _to_dds(self, sample):
        self._writer.write(Twist.deserialize(sample.payload.to_bytes()))

    def pump(self):
        for odometry in self._reader.take(32):
            self._session.put("odom", odometry.serialize())

    def close(self):
        self._session.close()


@pytest.fixture
def domain(monkeypatch):
    monkeypatch.setenv("CYCLONEDDS_URI", dds_robot.LOOPBACK)
    return secrets.randbelow(100)  # those above have ports that the system gives to others


def test_a_dds_participant_is_driven_and_stopped_at_the_end(domain):
    command = [sys.executable, "-m", "tests.ros2.dds_robot", str(domain)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=os.environ) as robot:
        bridge = Bridge(domain)
        wheel = Wheel(ros2.Robot(Ros2(endpoint=bridge.endpoint)))

        def moves():
            bridge.pump()
            return wheel.state is not None and not wheel.state.guard and wheel.state.v_mps > 0.09

        wheel.v_mps = 0.1
        wheel.until(moves)
        assert wheel.state.odometry_x_m > 0.0
        wheel.v_mps = 0.0
        wheel.until(lambda: bridge.pump() or wheel.state.v_mps == 0.0)
        wheel.device.close()
        said, _ = robot.communicate(timeout=DEADLINE_S)
        bridge.close()
    assert float(said) == 0.0
