"""Devices of components: the launch file's table, readings that enter the log and the fold, commands, and the end."""

import secrets
import socket

import pytest

from runtime.device import check_clock, kind_of, opened
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.replay import replay
from runtime.supervise import Supervisor
from tests.runtime.system import run_until

DEADLINE_S = 60.0


def launch(directory, device, clock="real"):
    file = directory / "line.toml"
    file.write_text(
        f"""
realm = "test/{secrets.token_hex(6)}"
[session]
clock = "{clock}"
[component.wheels]
run = "tests.runtime.parts.serial"
device = {device}
inputs = {{ device = "wheels/device" }}
[component.recorder]
run = "components.recorder"
"""
    )
    return load(file, recording=directory / "line.mcap")


@pytest.mark.parametrize(
    ("device", "words"),
    [
        ('{ kind = "lines" }', "wheels.device.kind must be one of line, played; got 'lines'"),
        ("{ baud = 1 }", "wheels.device.kind must be one of line, played; got None"),
        ('{ kind = "line", baud = 0 }', "wheels.device.baud must be > 0; got 0"),
        ('{ kind = "line", speed = 1 }', "wheels.device.speed is unknown; known are port, baud"),
        ('{ kind = "played", baud = 1 }', "wheels.device.baud is unknown; known are "),
        ('{ kind = ["line"] }', "wheels.device.kind must be one of line, played; got ['line']"),
    ],
)
def test_a_wrong_device_is_told_by_file_key_value_and_rule(tmp_path, device, words):
    with pytest.raises(ConfigurationError) as error:
        launch(tmp_path, device)
    assert str(error.value) == f"{tmp_path / 'line.toml'}: {words}"


def test_a_device_that_another_component_plays_is_none(tmp_path):
    spec = launch(tmp_path, '{ kind = "played" }', "lockstep").component("wheels")
    assert kind_of(spec) is None
    assert opened(spec, "") is None


def test_a_device_in_lockstep_is_refused_by_name(tmp_path):
    check_clock(launch(tmp_path, '{ kind = "line" }'))
    with pytest.raises(ConfigurationError, match=r"wheels\.device must not be 'line' in lockstep"):
        check_clock(launch(tmp_path, '{ kind = "line" }', "lockstep"))


class Far:
    """The other end of the line."""

    def __init__(self, listener):
        listener.settimeout(DEADLINE_S)
        self._socket, _ = listener.accept()
        self._socket.settimeout(DEADLINE_S)
        self._lines = self._socket.makefile("r")

    def says(self, number):
        self._socket.sendall(bytes((number,)))
        return self._lines.readline().strip()

    def rest(self):
        return self._lines.read().split()

    def hang_up(self):
        self._socket.shutdown(socket.SHUT_WR)


@pytest.fixture
def listener(tmp_path):
    with socket.socket(socket.AF_UNIX) as found:
        found.bind(str(tmp_path / "line"))
        found.listen()
        yield found


def test_a_device_is_read_told_logged_and_closed_and_its_session_replays_without_it(tmp_path, listener):
    system = launch(tmp_path, f'{{ kind = "line", port = "{tmp_path / "line"}" }}')
    with Supervisor(system) as supervisor:
        far = Far(listener)
        assert [far.says(number) for number in (1, 2, 100)] == ["2", "4", "200"]
        supervisor.poll(0.1)
        supervisor.stop()
        assert far.rest() == ["-1", "closed"], "its last command, then its end"
    assert supervisor.deaths == []
    recording = Recording(tmp_path / "line.mcap")
    read = [logged.decoded().v_mps for logged in recording.messages({"wheels/device"})]
    assert read == [1, 2, 100]
    report = replay(recording, "wheels")
    assert not report.differs
    assert not report.is_lossy
    assert report.outputs == {"wheels/actuate": 4}


def test_a_device_that_goes_away_ends_its_component_with_one_line(tmp_path, listener):
    system = launch(tmp_path, f'{{ kind = "line", port = "{tmp_path / "line"}" }}')
    with Supervisor(system) as supervisor:
        far = Far(listener)
        assert far.says(1) == "2"
        far.hang_up()
        run_until(supervisor)
        assert supervisor.end_reason == "wheels ended with exit code 1: wheels: line was closed"
        assert far.rest() == ["closed"]


def test_a_device_that_is_not_there_is_told_in_one_line(tmp_path):
    with Supervisor(launch(tmp_path, f'{{ kind = "line", port = "{tmp_path / "line"}" }}')) as supervisor:
        run_until(supervisor)
        assert supervisor.end_reason.startswith("wheels ended with exit code 1: wheels: line ")
        assert supervisor.end_reason.endswith("can not be opened: No such file or directory")
