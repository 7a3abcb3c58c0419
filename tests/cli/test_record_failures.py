"""A session whose recorder can not go on: it ends with a clear word, the robot stops, what was written is there."""

import os
import resource
import signal
import time

import pytest

from runtime.recording import Recording
from runtime.supervise import Supervisor
from tests.cli.running import is_growing, messages
from tests.runtime.system import recorded_system, run_until

pytestmark = pytest.mark.xdist_group("live")
STOPPED = -2.0
"""What echo commands at the stop."""


@pytest.fixture
def session(tmp_path):
    """Runs a system until it has recorded something, does something to the recorder, and waits for the end."""

    def run(harm, moments_s=None, **options):
        system = recorded_system(tmp_path, ["world.frames=0"], **{"clock": "10", **options})
        supervisor = Supervisor(system)
        speeds = []

        def hear(message, _):
            speeds.append(message.v_mps)
            if moments_s is not None:
                moments_s.append(time.monotonic())

        supervisor.watch("echo/drive", hear)
        with supervisor:
            run_until(supervisor, is_growing(system.recording))
            harm(supervisor, system.recording)
            run_until(supervisor)
            supervisor.stop()
            run_until(supervisor)
        return supervisor, system.recording, speeds

    return run


def fill_disk(supervisor, file):
    size = file.stat().st_size + 100
    resource.prlimit(supervisor.pids["recorder"], resource.RLIMIT_FSIZE, (size, size))


def test_a_full_disk_ends_the_session_and_stops_the_robot(session):
    supervisor, file, speeds = session(fill_disk)
    assert "session.mcap: can not be written any more: File too large; it is kept up to" in supervisor.end_reason
    assert supervisor.exit_code == 1
    assert speeds[-1] == STOPPED
    assert messages(file)


def test_a_removed_file_ends_the_session_and_is_there_again(session):
    supervisor, file, speeds = session(lambda _, file: file.unlink())
    assert "session.mcap: was removed while it was recorded" in supervisor.end_reason
    assert speeds[-1] == STOPPED
    sequences = [row.sequence for row in messages(file) if row.topic == "world/image"]
    assert sequences == list(range(len(sequences)))
    assert sequences


def test_a_folder_that_takes_no_file_ends_the_session_before_it_begins(tmp_path):
    (tmp_path / "file").touch()
    system = recorded_system(tmp_path, ["world.frames=0"])
    spec = system.component("recorder")
    spec.params["file"] = str(tmp_path / "file" / "x.mcap")
    with Supervisor(system) as supervisor:
        run_until(supervisor)
    assert "recorder: " in supervisor.end_reason
    assert "x.mcap: can not be made: " in supervisor.end_reason
    assert supervisor.exit_code == 1


@pytest.mark.parametrize("clock", ["lockstep", "10"])
def test_a_killed_recorder_costs_less_than_a_second(session, clock):
    seen = []  # wall time of each command
    killed_s: list[float] = []

    def kill(supervisor, _):
        until_s = time.monotonic() + 0.7
        while time.monotonic() < until_s and supervisor.poll(0.01):
            pass
        os.kill(supervisor.pids["recorder"], signal.SIGKILL)
        killed_s.append(time.monotonic())

    supervisor, file, speeds = session(kill, seen, clock=clock)
    assert supervisor.end_reason == "recorder was killed by SIGKILL"
    assert speeds[-1] == STOPPED
    assert not Recording(file).whole()
    drives = [row.sequence for row in messages(file) if row.topic == "echo/drive"]
    assert drives == list(range(len(drives)))
    lost_s = killed_s[0] - seen[len(drives)]
    assert 0 <= lost_s < 1.0
