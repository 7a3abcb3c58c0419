"""`berth check hardware` and `berth tune head` through the serial protocol of an emulated robot."""

import pytest

from benchmarks.pioneer import LATE
from runtime.launch import load
from tests.components.inspecting_world import inspect
from tests.recorded_session import LAUNCH

UPSIDE_DOWN = {"pan motor", "pan encoder", "tilt motor", "tilt encoder"}


def robot(folder, wiring):
    """The simulation with a serial line before its robot; wired as told."""
    file = folder / "serial.toml"
    text = LAUNCH.read_text(encoding="utf-8")
    file.write_text(text.replace('"components.simulator"', '"tests.pioneer.serial_world"'), encoding="utf-8")
    late = LATE[0].replace("{", f"{{{wiring}, " if wiring else "{")
    return load(file, [late, *LATE[1:]], clock="lockstep")


@pytest.mark.parametrize(("wiring", "things"), [("tilt=-1", UPSIDE_DOWN), ("turn=-1, forward=-1", {"turn", "drive"})])
def test_a_wrong_sign_behind_the_serial_line_is_found_and_its_correction_passes(tmp_path, wiring, things):
    found = inspect(robot(tmp_path, wiring), "facing")
    assert (found.result.reason, found.wrong) == ("finished", things)
    assert found.moved_m < 0.05
    assert found.turned_deg < 10.0
    again = inspect(found.right, "facing")
    assert (again.result.reason, again.wrong) == ("finished", set())


def test_the_gripper_behind_the_serial_line_is_found_right(tmp_path):
    found = inspect(robot(tmp_path, ""), "fingertips")
    assert (found.result.reason, found.wrong) == ("finished", set())


def test_a_camera_whose_commands_take_turns_with_questions_is_not_measured_wrongly(tmp_path):
    """Their delay varies by 0.15 s, more than what is looked for: that is said, and nothing is proposed."""
    found = inspect(robot(tmp_path, ""), "head")
    assert (found.result.reason, found.wrong) == ("finished", {"head"})
    assert found.right == found.system
