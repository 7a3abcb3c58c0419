"""A camera unplugged in the middle of a drive: the robot rests, and drives on when it is back. On the bus, real time.

`launch/peoplebot.toml` with the real components; of the machines only the robot and the camera's driver are played.
"""

import secrets
import time
from pathlib import Path

import numpy as np
import pytest

from components.simulator.messages import Reporter
from components.simulator.params import Params
from docking.angles import DEG
from docking.starts import Start
from runtime.launch import load
from runtime.recording import Recording
from runtime.supervise import Supervisor
from tests.camera.fake_v4l2 import Lens, Shows, environment
from tests.pioneer.body import Body
from tests.pioneer.cameras import Canon
from tests.pioneer.served import Serial, Served

pytestmark = pytest.mark.xdist_group("session")
LAUNCH = Path(__file__).parents[2] / "launch" / "peoplebot.toml"
DEADLINE_S = 90.0
FAR = Start(2 * DEG, -2 * DEG, 0.95)
SETTINGS = ["pilot.train_s=0", "pilot.evaluation_trials=3", "pilot.evaluation_controller=lc"]


def launch_file(folder, port, camera):
    """The robot's launch file with these ports, in a realm of its own."""
    text = LAUNCH.read_text(encoding="utf-8")
    for before, after in (
        ('"berth/peoplebot"', f'"test/{secrets.token_hex(6)}"'),
        ('"/dev/ttyUSB0"', f'"{port}"'),
        ("/tmp/berth-aux", str(folder / "aux")),  # noqa: S108  (what the launch file says)
        ('"/dev/video0"', f'"{camera}"'),
    ):
        assert before in text
        text = text.replace(before, after)
    file = folder / "peoplebot.toml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.fixture
def robot():
    body = Body(Params(), FAR, 0)
    head = Canon(lambda: body.head, inverted=True)
    with Served(Serial(), body, cameras={1: head}) as served:
        yield served


@pytest.fixture
def lens(tmp_path, robot, monkeypatch):
    """A camera at 30 frames a second that sees what the robot's would."""
    found = Lens(tmp_path / "video0")
    for name, value in environment(found.path).items():
        monkeypatch.setenv(name, value)  # for the components' processes
    reporter, chance = Reporter(Params(), 1), np.random.default_rng(1)

    def picture():
        with robot.turn:
            return reporter._image(robot.body, chance).data

    shows = Shows(found, picture)
    yield found
    shows.close()
    found.close()


def test_an_unplugged_camera_stops_the_robot_and_a_plugged_one_lets_it_drive_on(tmp_path, robot, lens):
    system = load(launch_file(tmp_path, robot.end.port, lens.path), SETTINGS, recording=tmp_path / "session.mcap")
    supervisor = Supervisor(system)

    def until(condition):
        deadline_s = time.monotonic() + DEADLINE_S
        while not condition():
            assert supervisor.poll(0.02), supervisor.end_reason
            assert time.monotonic() < deadline_s, supervisor.missing
        return time.monotonic()

    with supervisor:
        until(lambda: abs(robot.v_mps) > 0.05)
        pulled_s = time.monotonic()
        lens.unplug()
        rests_s = until(lambda: abs(robot.v_mps) == 0.0)
        until(lambda: time.monotonic() > rests_s + 1.0)
        assert abs(robot.v_mps) == 0.0
        lens.plug()
        until(lambda: abs(robot.v_mps) > 0.05)
        supervisor.stop()
    assert supervisor.deaths == []
    assert not robot.body.collided
    assert rests_s - pulled_s < 5.0, "max_age_s and braking, on a busy machine"
    recording = Recording(tmp_path / "session.mcap")
    stamps_ns = [logged.capture_ns for logged in recording.messages({"camera/image"})]
    assert np.diff(stamps_ns).min() > 0
    assert np.median(np.diff(stamps_ns)) > 0.08e9, "of 30 frames a second 8"
    assert np.diff(stamps_ns).max() > 1e9, "the gap is in the log"
