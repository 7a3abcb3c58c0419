"""The emulated ROS 2 base in real time, at a zenoh router. `python -m tests.ros2.served` shows one."""

from __future__ import annotations

import argparse
import contextlib
import sys
import threading
from collections import deque

import zenoh

from components.simulator.params import Params
from docking.starts import Start
from runtime.bus import _config, free_endpoint, never_drop, open_peer
from tests.driven import Driven
from tests.living import Living
from tests.ros2.robot import Robot

_ROUTER = {"routing/router/peers_failover_brokering": False}
"""As rmw_zenoh's routers have it: one peer hears nothing of another that it can not reach itself."""


class Served(Living):
    """Its bridge is the router; of rmw_zenoh, its node is a peer of one."""

    def __init__(self, body=None, endpoint=None, **robot):
        super().__init__(body or Driven(Params(), Start(0.0, 0.0, 50.0), 0))
        self.endpoint = endpoint or free_endpoint()
        self.robot = Robot(self.body, **robot)
        self.body.twist = self.robot.twist
        self._heard = deque(maxlen=256)
        self._sessions = []
        self.plug()

    def plug(self):
        self._sessions.append(zenoh.open(_config("router", [self.endpoint], [], _ROUTER)))
        never_drop(self._sessions[-1])
        if self.robot.bridge == "rmw_zenoh":
            self._sessions.append(open_peer(self.endpoint))
        self._sessions[-1].declare_subscriber(self.robot.command_key, self._hear)

    def _hear(self, sample):
        attachment = sample.attachment
        self._heard.append((sample.payload.to_bytes(), None if attachment is None else attachment.to_bytes()))

    def exchange(self, now_ns):
        while self._heard:
            self.robot.hear(*self._heard.popleft(), now_ns)
        for said in self.robot.speak(now_ns):
            if self._sessions:
                self._sessions[-1].put(said.key, said.payload, attachment=said.attachment)

    def tokens(self, keys):
        """Of the living, that its router knows."""
        with self.turn:
            return {str(reply.ok.key_expr) for reply in self._sessions[0].liveliness().get(keys)}

    def pull(self):
        """Nobody reaches it any more, until `plug`."""
        with self.turn:
            self.close()

    def close(self):
        while self._sessions:
            self._sessions.pop().close()


def main():
    """Serve until interrupted."""
    asked = argparse.ArgumentParser(prog="python -m tests.ros2.served", description=main.__doc__)
    asked.add_argument("--endpoint", default="tcp/127.0.0.1:7447")
    asked.add_argument("--bridge", choices=("ros2dds", "rmw_zenoh"), default="ros2dds")
    options = asked.parse_args()
    with Served(endpoint=options.endpoint, bridge=options.bridge) as served:
        sys.stdout.write(f"a robot is at {served.endpoint}; it obeys {served.robot.command_key}\n")
        sys.stdout.flush()
        with contextlib.suppress(KeyboardInterrupt):
            threading.Event().wait()


if __name__ == "__main__":
    main()
