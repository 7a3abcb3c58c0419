"""The robot as a device of base, at a pseudo-terminal and at a TCP port, in real time."""

import os
import secrets
import signal

import pytest

from components.base.devices import pioneer
from components.base.ports import Pioneer
from runtime.contract import DeviceError
from runtime.launch import load
from runtime.supervise import Supervisor
from tests.pioneer.served import Network, Serial, Served
from tests.runtime.system import run_until
from tests.wheel import Wheel, come_to_rest


def driven(params):
    return Wheel(pioneer.Robot(params))


@pytest.fixture(params=[Serial, Network])
def served(request):
    with Served(request.param()) as found:
        yield found


def test_a_robot_is_driven_and_stopped_at_the_end(served):
    wheel = driven(Pioneer(port=served.end.port)).ready()
    wheel.v_mps = 0.1
    wheel.until(lambda: wheel.state.v_mps > 0.09)
    assert wheel.state.watchdog_s == 2.0
    wheel.device.close()
    come_to_rest(served)
    assert not served.robot.open


def test_a_robot_at_another_speed_is_found():
    with Served(Serial(baud=38400)) as served:
        wheel = driven(Pioneer(port=served.end.port)).ready()
        wheel.device.close()


def test_a_connection_that_ends_is_told_and_made_anew():
    with Served(Network()) as served:
        wheel = driven(Pioneer(port=served.end.port)).ready()
        wheel.v_mps = 0.1
        wheel.until(lambda: wheel.state.v_mps > 0.05)
        served.pull()
        wheel.until(lambda: wheel.state.guard)
        assert wheel.state.fault == "not connected"
        wheel.v_mps = 0.0
        wheel.ready()
        assert served.v_mps < 0.01
        wheel.device.close()


def test_a_cable_that_is_pulled_is_told(capsys):
    with Served(Serial()) as served:
        wheel = driven(Pioneer(port=served.end.port)).ready()
        served.pull()
        wheel.until(lambda: wheel.state.guard)
        wheel.device.close()
        assert "has ended" in capsys.readouterr().out


def test_a_port_that_is_not_there_is_told_in_one_line(tmp_path):
    with pytest.raises(DeviceError, match=r"robot at .*nothing can not be opened: .*"):
        pioneer.Robot(Pioneer(port=str(tmp_path / "nothing")))


LAUNCH = """
realm = "test/{realm}"
[session]
clock = "real"
[component.commander]
run = "tests.pioneer.commander"
[component.base]
run = "components.base"
device = {{ kind = "pioneer", port = "{port}" }}
inputs = {{ pilot = "commander/drive", device = "base/device" }}
params = {{ commanders = ["pilot"] }}
"""


def test_a_driver_that_is_killed_leaves_a_robot_at_rest_long_before_its_watchdog(tmp_path):
    with Served(Serial(), watchdog_ms=60_000) as served:
        file = tmp_path / "robot.toml"
        file.write_text(LAUNCH.format(realm=secrets.token_hex(6), port=served.end.port))
        with Supervisor(load(file)) as supervisor:
            run_until(supervisor, lambda: served.v_mps > 0.003)
            os.kill(supervisor.pids["base"], signal.SIGKILL)
            run_until(supervisor, lambda: False)
            assert supervisor.end_reason.startswith("base was killed by SIGKILL")
            assert served.robot.open, "its own watchdog would let it drive for a minute"
            come_to_rest(served)
