"""The launch files' robot, emulated, with a camera whose pictures and angles are those of one world, in real time."""

from __future__ import annotations

import contextlib
import math
import re
import secrets
import socket
import struct
import threading
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

from components.simulator.messages import Reporter
from components.simulator.params import Params
from docking.angles import DEG
from docking.starts import Start
from tests.pioneer.body import Body
from tests.pioneer.cameras import Canon
from tests.pioneer.served import Serial, Served

LAUNCH = Path(__file__).parents[2] / "launch" / "peoplebot.toml"
DEADLINE_S = 120.0
NEAR = Start(2 * DEG, -2 * DEG, 0.75)
_FRAME_S = 0.125


class Shown(NamedTuple):
    """Where the object truly was when a picture was taken, seen from the robot."""

    monotonic_ns: int
    bearing_rad: float
    depression_rad: float


class Showing:
    """Shows what the robot's camera sees, eight times a second, to whoever has connected."""

    def __init__(self, path, served):
        self._served = served
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(str(path))
        self._listener.listen()
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._show, daemon=True)
        self._reporter = Reporter(Params(), 1)
        self.shown = []
        self._thread.start()

    def _show(self):
        self._listener.settimeout(DEADLINE_S)
        end, _ = self._listener.accept()
        chance = np.random.default_rng(1)
        while not self._done.wait(_FRAME_S):
            with self._served.turn:
                body = self._served.body
                yaw_rad, depression_rad = body.camera.towards(np.zeros(3))
                bearing_rad = math.remainder(yaw_rad - body.base.pose.heading_rad, 2 * math.pi)
                self.shown.append(Shown(time.monotonic_ns(), bearing_rad, depression_rad))
                picture = self._reporter._image(body, chance).data
            try:
                end.sendall(struct.pack("<I", len(picture)) + picture)
            except OSError:
                return

    def close(self):
        self._done.set()
        self._thread.join(5.0)
        self._listener.close()


@contextlib.contextmanager
def peoplebot(folder, start=NEAR, camera=Canon, **options):
    """The robot at a pseudo-terminal with its camera at the auxiliary port, and the eyes' socket in a folder.

    Args:
        folder: for sockets.
        start: where it stands.
        camera: kind of camera.
        options: of the camera; it hangs upside down.
    """
    body = Body(Params(home_tilt_rad=0.0), start, 0)
    mounted = camera(lambda: body.head, **{"inverted": True, **options})
    with Served(Serial(), body, cameras={1: mounted}) as served:
        served.showing = Showing(folder / "eyes", served)
        try:
            yield served
        finally:
            served.showing.close()


EYES = """[component.camera]
run = "tests.pioneer.eyes"
device = {{ kind = "pictures", port = "{port}" }}
outputs = {{ device = "camera/image" }}

"""


def launch_file(folder, launch, replaced):
    """A launch file with other ports, in a realm of its own, whose camera is the eyes' socket in a folder.

    Args:
        folder: where it is put.
        launch: the file as it is delivered.
        replaced: words of it, and what stands there instead.
    """
    text = launch.read_text(encoding="utf-8")
    (camera,) = re.findall(r"^\[component\.camera\].*?(?=^\[)", text, re.DOTALL | re.MULTILINE)
    own = {f'"berth/{launch.stem}"': f'"test/{secrets.token_hex(6)}"', camera: EYES.format(port=folder / "eyes")}
    for before, after in {**own, **replaced}.items():
        assert before in text
        text = text.replace(before, after)
    file = folder / launch.name
    file.write_text(text, encoding="utf-8")
    return file


def peoplebot_file(folder, port):
    """The PeopleBot's launch file with this robot's port."""
    aux = "/tmp/berth-aux"  # noqa: S108  (what the launch file says)
    return launch_file(folder, LAUNCH, {'"/dev/ttyUSB0"': f'"{port}"', aux: str(folder / "aux")})
