"""The emulated robot in real time, at a pseudo-terminal or a TCP port. `python -m tests.pioneer.served` shows one."""

from __future__ import annotations

import argparse
import contextlib
import os
import select
import socket
import sys
import termios
import threading
import tty

from components.simulator.params import Params
from docking.starts import Start
from tests.living import Living
from tests.pioneer.body import Body
from tests.pioneer.cameras import Canon, Sony
from tests.pioneer.robot import Robot

_BYTES = 4096
_SPEEDS = {9600: termios.B9600, 19200: termios.B19200, 38400: termios.B38400, 57600: termios.B57600,
           115200: termios.B115200}  # fmt: skip


class Serial:
    """The robot's end of a serial cable. At another speed than the robot's only garbage passes."""

    def __init__(self, baud=9600):
        self.baud = baud
        self.plug()

    def plug(self):
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.port = os.ttyname(self._slave)

    def pull(self):
        """Whoever has it open is told that it has ended."""
        os.close(self._slave)
        os.close(self._master)
        self._master = -1

    def read(self):
        if self._master < 0 or not select.select([self._master], [], [], 0)[0]:
            return b""
        return self._as_heard(os.read(self._master, _BYTES))

    def write(self, data):
        if self._master >= 0:
            with contextlib.suppress(BlockingIOError):
                os.write(self._master, self._as_heard(data))

    def _as_heard(self, data):
        return data if termios.tcgetattr(self._master)[4] == _SPEEDS[self.baud] else bytes(b ^ 0x55 for b in data)

    def close(self):
        if self._master >= 0:
            self.pull()


class Network:
    """The robot's end of a network connection; the newest client counts."""

    def __init__(self, port=0):
        self._listener = socket.create_server(("127.0.0.1", port))
        self._listener.setblocking(False)
        self._client = None
        self.port = f"tcp://127.0.0.1:{self._listener.getsockname()[1]}"

    def read(self):
        with contextlib.suppress(BlockingIOError):
            client, _ = self._listener.accept()
            client.setblocking(False)
            self._client = client
        try:
            return self._client.recv(_BYTES) if self._client is not None else b""
        except (BlockingIOError, ConnectionError):
            return b""

    def write(self, data):
        if self._client is not None:
            with contextlib.suppress(OSError):
                self._client.send(data)

    def pull(self):
        if self._client is not None:
            self._client.close()
            self._client = None

    def close(self):
        self.pull()
        self._listener.close()


class Served(Living):
    """A robot at one end of a line."""

    def __init__(self, end, body=None, **robot):
        super().__init__(body or Body(Params(), Start(0.0, 0.0, 50.0), 0))
        self.end = end
        self.robot = Robot(self.body, **robot)
        self.body.twist = self.robot.twist

    def exchange(self, now_ns):
        self.robot.hear(self.end.read(), now_ns)
        said = self.robot.speak(now_ns)
        if said:
            self.end.write(said)

    def pull(self):
        with self.turn:
            self.end.pull()

    def close(self):
        self.end.close()


def main():
    """Serve until interrupted, at a pseudo-terminal or, with `--port 8101`, over TCP; a camera at its AUX port."""
    asked = argparse.ArgumentParser(prog="python -m tests.pioneer.served", description=main.__doc__)
    asked.add_argument("--port", type=int)
    asked.add_argument("--camera", choices=("canon", "sony"), default="canon")
    options = asked.parse_args()
    body = Body(Params(), Start(0.0, 0.0, 50.0), 0)
    camera = {"canon": Canon, "sony": Sony}[options.camera](lambda: body.head)
    end = Serial() if options.port is None else Network(options.port)
    with Served(end, body, cameras={1: camera}):
        sys.stdout.write(f"a robot is at {end.port}\n")
        sys.stdout.flush()
        with contextlib.suppress(KeyboardInterrupt):
            threading.Event().wait()


if __name__ == "__main__":
    main()
