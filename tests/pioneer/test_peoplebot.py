"""`launch/peoplebot.toml` from its first packet to the pick-up, against the emulated robot, in real time."""

import secrets
import socket
import struct
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from components.simulator.messages import Reporter
from components.simulator.params import Params
from docking.angles import DEG
from docking.starts import Start
from runtime.launch import load
from runtime.supervise import Supervisor
from tests.pioneer.body import Body
from tests.pioneer.cameras import Canon
from tests.pioneer.served import Serial, Served

LAUNCH = Path(__file__).parents[2] / "launch" / "peoplebot.toml"
DEADLINE_S = 120.0
NEAR = Start(2 * DEG, -2 * DEG, 0.75)


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
        self._thread.start()

    def _show(self):
        self._listener.settimeout(DEADLINE_S)
        end, _ = self._listener.accept()
        chance = np.random.default_rng(1)
        while not self._done.wait(0.125):
            with self._served.turn:
                picture = self._reporter._image(self._served.body, chance).data
            try:
                end.sendall(struct.pack("<I", len(picture)) + picture)
            except OSError:
                return

    def close(self):
        self._done.set()
        self._thread.join(5.0)
        self._listener.close()


@pytest.fixture
def robot(tmp_path):
    body = Body(Params(), NEAR, 0)
    camera = Canon(lambda: body.head, inverted=True)
    with Served(Serial(), body, cameras={1: camera}) as served:
        showing = Showing(tmp_path / "eyes", served)
        yield served
        showing.close()


EYES = """run = "tests.pioneer.eyes"
device = {{ kind = "pictures", port = "{port}" }}
outputs = {{ device = "camera/image" }}"""


def launch_file(directory, port):
    """`launch/peoplebot.toml` with this robot's ports, in a realm of its own."""
    text = LAUNCH.read_text(encoding="utf-8")
    for before, after in (
        ('"berth/peoplebot"', f'"test/{secrets.token_hex(6)}"'),
        ('"/dev/ttyUSB0"', f'"{port}"'),
        ("/tmp/berth-aux", str(directory / "aux")),  # noqa: S108  (what the launch file says)
        ('run = "components.camera"', EYES.format(port=directory / "eyes")),
    ):
        assert before in text
        text = text.replace(before, after)
    file = directory / "peoplebot.toml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.xdist_group("session")
def test_the_peoplebot_docks_and_picks_up(tmp_path, robot):
    settings = ["pilot.train_s=0", "pilot.evaluation_trials=3", "pilot.evaluation_controller=lc"]
    system = load(launch_file(tmp_path, robot.end.port), settings, recording=tmp_path / "session.mcap")
    deadline_s = time.monotonic() + DEADLINE_S
    held, trials = False, set()
    supervisor = Supervisor(system)
    supervisor.watch("pilot/trial", lambda trial, _: trials.add((trial.number, trial.mode, trial.outcome)))
    with supervisor:
        while supervisor.poll(0.1) and not held:
            assert time.monotonic() < deadline_s, trials
            with robot.turn:
                held = robot.body.gripper.holding
    assert held, (supervisor.end_reason, trials)
    assert robot.body.gripper.holding
    assert not robot.body.collided
    assert robot.v_mps == 0.0
