"""A ROS 2 base as a device, over zenoh, in real time."""

import importlib
import os
import secrets
import signal
import sys

import pytest

from components.base.devices import ros2
from components.base.ports import Ros2
from runtime.bus import free_endpoint
from runtime.contract import DeviceError
from runtime.launch import load
from runtime.supervise import Supervisor
from tests.ros2.served import Served
from tests.runtime.system import run_until
from tests.wheel import Wheel, come_to_rest

pytestmark = pytest.mark.xdist_group("live")


def at_the_wheel(served):
    params = Ros2(endpoint=served.endpoint, bridge=served.robot.bridge, battery="battery_state")
    return Wheel(ros2.Robot(params))


@pytest.mark.parametrize("bridge", ["ros2dds", "rmw_zenoh"])
def test_a_robot_without_a_timeout_is_driven_known_to_its_tools_and_stopped_at_the_end(bridge):
    with Served(bridge=bridge, timeout_s=None) as served:
        wheel = at_the_wheel(served).ready()
        wheel.v_mps = 0.1
        wheel.until(lambda: wheel.state.v_mps > 0.09 and wheel.state.battery_v == 12.5)
        tokens = served.tokens("@ros2_lv/**")
        wheel.device.close()
        come_to_rest(served)
        assert served.robot.heard[-1][1:] == (0.0, 0.0)
        assert served.robot.unheard == 0
    kinds = sorted(token.split("/")[5] for token in tokens)
    assert kinds == (["MP", "MS", "MS", "NN"] if bridge == "rmw_zenoh" else [])


def test_a_router_that_goes_is_told_and_found_again_and_the_robot_rests_until_it_is_told_again():
    with Served(bridge="rmw_zenoh") as served:
        wheel = at_the_wheel(served).ready()
        wheel.v_mps = 0.1
        wheel.until(lambda: wheel.state.v_mps > 0.05)
        served.pull()
        wheel.until(lambda: wheel.state.guard)
        assert wheel.state.fault == "no odometry for 1 s"
        wheel.v_mps = 0.0
        served.plug()
        wheel.ready()
        assert served.v_mps < 0.01
        wheel.device.close()


def test_a_robot_that_comes_later_is_found(capsys):
    endpoint = free_endpoint()
    wheel = Wheel(ros2.Robot(Ros2(endpoint=endpoint)))
    wheel.until(lambda: wheel.state is not None)
    assert (wheel.state.guard, wheel.state.fault) == (True, "no odometry on /odom")
    assert f"robot: nobody at {endpoint}" in capsys.readouterr().out
    with Served(endpoint=endpoint):
        wheel.ready()
        wheel.device.close()


def test_without_its_libraries_the_device_is_refused_in_one_line(monkeypatch):
    monkeypatch.setitem(sys.modules, "xxhash", None)
    for name in [name for name in sys.modules if name.startswith(("components.base.ros2", ros2.__name__))]:
        monkeypatch.delitem(sys.modules, name)
    with pytest.raises(DeviceError, match=r"ros2 needs xxhash: pip install 'berth\[ros2\]'"):
        importlib.import_module(ros2.__name__)


LAUNCH = """
realm = "test/{realm}"
[session]
clock = "real"
[component.commander]
run = "tests.pioneer.commander"
[component.base]
run = "components.base"
device = {{ kind = "ros2", endpoint = "{endpoint}", bridge = "rmw_zenoh" }}
inputs = {{ pilot = "commander/drive", device = "base/device" }}
params = {{ commanders = ["pilot"] }}
"""


def test_a_driver_that_is_killed_leaves_a_robot_at_rest_that_has_no_timeout_of_its_own(tmp_path):
    with Served(bridge="rmw_zenoh", timeout_s=None) as served:
        file = tmp_path / "robot.toml"
        file.write_text(LAUNCH.format(realm=secrets.token_hex(6), endpoint=served.endpoint))
        with Supervisor(load(file)) as supervisor:
            run_until(supervisor, lambda: served.v_mps > 0.003)
            os.kill(supervisor.pids["base"], signal.SIGKILL)
            run_until(supervisor, lambda: False)
            assert supervisor.end_reason.startswith("base was killed by SIGKILL")
            come_to_rest(served)
