"""`berth check` of a robot's launch file where there is no robot: the simulator plays its devices."""

import json

import pytest

from cli.stand_in import devices, has_world, simulated
from runtime.launch import load
from runtime.params import ConfigurationError
from tests.recorded_session import LAUNCH

ROBOTS = {"peoplebot": "pioneer", "paper-robot": "pioneer", "ros2": "ros2"}


@pytest.mark.parametrize("name", ROBOTS)
def test_the_simulator_takes_the_place_of_a_robot_s_devices_and_nothing_else_changes(name):
    system = load(LAUNCH.with_name(f"{name}.toml"), clock="lockstep")
    made = simulated(system)
    assert {"head (canon-vc-c4)", f"base ({ROBOTS[name]})"} <= set(devices(system))
    assert not has_world(system)
    assert (devices(made), has_world(made)) == ([], True)
    names = {spec.name for spec in system.components if not spec.tap}
    assert {spec.name for spec in made.components} == names - {"camera"} | {"simulator"}
    for spec in made.components[1:]:
        assert spec.params == system.component(spec.name).params
    assert made.component("simulator").params["task"] == system.component("pilot").params["task"]


def test_check_tries_every_component_of_a_robot_without_it(run):
    code, out, _ = run("check", LAUNCH.with_name("peoplebot.toml"), "--duration", "1", "--json")
    table = json.loads(out)
    assert (code, table["kept"]) == (0, True)
    tried = {row["component"] for row in table["findings"] if row["rule"].startswith("same bytes")}
    assert {"vision", "head", "tracker", "pilot", "learner", "grasper", "base"} <= tried
    (absent,) = (row["detail"] for row in table["findings"] if row["component"] == "devices")
    assert "pioneer" in absent


EYELESS = """
realm = "test/eyeless"
[component.pilot]
run = "tests.pioneer.commander"
[component.base]
run = "components.base"
device = { kind = "pioneer" }
inputs = { pilot = "pilot/drive", device = "base/device" }
"""


def test_what_the_simulator_can_not_play_is_said_in_one_line(run, tmp_path):
    file = tmp_path / "eyeless.toml"
    file.write_text(EYELESS, encoding="utf-8")
    with pytest.raises(ConfigurationError, match="one camera"):
        simulated(load(file, clock="lockstep"))
    code, out, _ = run("check", file, "--json")
    words = [row["detail"] for row in json.loads(out)["findings"] if row["component"] == "components"]
    assert code == 0
    assert len(words) == 1
    assert "nothing was run" in words[0]
