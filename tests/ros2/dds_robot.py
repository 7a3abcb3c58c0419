"""The emulated base as a DDS participant in a process of its own, with the names that ROS 2's nodes have there.

`python -m tests.ros2.dds_robot DOMAIN` drives until its standard input ends; then it says how fast it is.
"""

from __future__ import annotations

import sys

from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from components.simulator.params import Params
from docking.starts import Start
from tests.driven import Driven
from tests.living import Living
from tests.ros2.messages import Odometry, Twist
from tests.ros2.robot import Robot

LOOPBACK = """<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""
"""For the environment as CYCLONEDDS_URI: nothing leaves this machine."""


class DdsRobot(Living):
    def __init__(self, domain):
        super().__init__(Driven(Params(), Start(0.0, 0.0, 50.0), 0))
        self.robot = Robot(self.body)
        self.body.twist = self.robot.twist
        participant = DomainParticipant(domain)
        self.reader = DataReader(participant, Topic(participant, "rt/cmd_vel", Twist))
        self.writer = DataWriter(participant, Topic(participant, "rt/odom", Odometry))

    def exchange(self, now_ns):
        for twist in self.reader.take(32):
            self.robot.hear(twist.serialize(), None, now_ns)
        for said in self.robot.speak(now_ns):
            if said.key == "odom":
                self.writer.write(Odometry.deserialize(said.payload))


if __name__ == "__main__":
    with DdsRobot(int(sys.argv[1])) as there:
        sys.stdin.read()
        print(there.v_mps)  # noqa: T201
