"""`berth check hardware` and `berth tune head`: what they ask, find, propose and write."""

import io
import json
import os
import signal
import sys
import tomllib

import pytest

from benchmarks.watched import wait_until
from cli.correction import Correction, lines, literal, write
from cli.main import main
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.runfile import running
from tests.cli.running import berth, finish
from tests.recorded_session import LAUNCH

PATCHES = [Correction("head", "pan_scale", -1.0), Correction("base", "beams_swapped", True)]
FOUND_S = 60.0


@pytest.fixture
def launch(tmp_path):
    """The simulation's launch file with some faults, to be edited."""
    file = tmp_path / "robot.toml"
    faults = "params = { wiring = { pan = -1.0, beams_swapped = true } }"
    text = LAUNCH.read_text(encoding="utf-8").replace("berth/sim", f"test/hardware-{os.getpid()}")
    mark = 'outputs = { image = "camera/image" }   # as on a robot\n'
    assert mark in text
    file.write_text(text.replace(mark, f"{mark}{faults}\n"), encoding="utf-8")
    return file


def called(monkeypatch, capsys, *words):
    monkeypatch.setattr(sys, "argv", ["berth", *map(str, words)])
    with pytest.raises(SystemExit) as exit_:
        main()
    return exit_.value.code, *capsys.readouterr()


def test_what_is_written_makes_the_next_check_pass(monkeypatch, capsys, launch):
    words = ("check", "hardware", launch, "--in-process", "--yes", "--json")
    code, out, _ = called(monkeypatch, capsys, *words, "--write")
    told = json.loads(out)
    assert (code, told["good"], told["reason"]) == (1, False, "finished")
    assert {row["param"]: row["value"] for row in told["corrections"]} == {"pan_scale": -1.0, "beams_swapped": True}
    assert told["robot_s"] < FOUND_S
    code, out, _ = called(monkeypatch, capsys, *words)
    assert (code, json.loads(out)["good"]) == (0, True)


def test_it_says_what_will_move_and_does_not_move_unasked(monkeypatch, capsys, launch):
    monkeypatch.setattr("sys.stdin", io.StringIO())
    for words in (("check", "hardware"), ("tune", "head")):
        code, out, err = called(monkeypatch, capsys, *words, launch, "--in-process")
        assert (code, out) == (2, "")
        assert "deg" in err
        assert "--yes" in err.splitlines()[-1]


def test_on_the_bus_a_stop_ends_it_with_one_line_and_no_process(launch):
    process = berth("check", "hardware", launch, "--yes", "--clock", "real", "--stage", "facing")
    realm = f"test/hardware-{os.getpid()}"
    try:
        assert wait_until(lambda: realm in {run.realm for run in running()}, 60.0)
        process.send_signal(signal.SIGINT)
        code, out, err = finish(process)
    finally:
        process.kill()
    assert code == 1, err
    assert out.strip() == "ended early: interrupted; the robot rests"
    assert realm not in {run.realm for run in running()}


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("check", "hardware", "none.toml", "--yes"), "none.toml"),
        (("check", "hardware", LAUNCH, "--yes", "--stage", "feet"), "--stage"),
        (("check", "hardware", LAUNCH, "--yes", "--set", "head.pan_scale=0"), "head.params.pan_scale must be not 0"),
        (("tune", "head", LAUNCH, "--yes", "--set", "tracker.camera_latency_s=9"), "tracker.params.camera_latency_s"),
    ],
)
def test_bad_input_is_one_line(monkeypatch, capsys, words, named):
    code, out, err = called(monkeypatch, capsys, *words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert named in err


def test_a_launch_file_alone_is_still_the_contract(monkeypatch, capsys):
    code, out, _ = called(monkeypatch, capsys, "check", "--json")
    assert (code, json.loads(out)["kept"]) == (0, True)


def test_writing_changes_nothing_else(tmp_path):
    file = tmp_path / "sim.toml"
    before = LAUNCH.read_text(encoding="utf-8")
    file.write_text(before, encoding="utf-8")
    write(file, PATCHES)
    after = file.read_text(encoding="utf-8")
    wanted = tomllib.loads(before)
    for component, param, value in PATCHES:
        wanted["component"][component].setdefault("params", {})[param] = value
    assert tomllib.loads(after) == wanted
    assert [row for row in before.splitlines() if "#" in row] == [row for row in after.splitlines() if "#" in row]
    assert load(file).component("head").params["pan_scale"] == -1.0


def test_the_lines_to_paste_are_what_is_written(tmp_path):
    file = tmp_path / "sim.toml"
    file.write_text(LAUNCH.read_text(encoding="utf-8"), encoding="utf-8")
    shown = tomllib.loads(lines(tomllib.loads(file.read_text(encoding="utf-8")), PATCHES))
    write(file, PATCHES)
    written = tomllib.loads(file.read_text(encoding="utf-8"))["component"]
    assert {name: written[name]["params"] for name in shown["component"]} == {
        name: entry["params"] for name, entry in shown["component"].items()
    }


@pytest.mark.parametrize(
    "layout",
    [
        '[component.head]\nrun = "h"\n[component.head.params]\npan_scale = 2.0 # two\n[component.base]\nrun = "b"\n',
        '[component.head]\nrun = "h"\n\n[component.base]\nrun = "b"\nparams = { dead_man = "a # b" } # why',
    ],
)
def test_other_layouts_are_edited_too(tmp_path, layout):
    file = tmp_path / "robot.toml"
    file.write_text(layout, encoding="utf-8")
    write(file, PATCHES)
    table = tomllib.loads(file.read_text(encoding="utf-8"))["component"]
    assert table["head"]["params"]["pan_scale"] == -1.0
    assert table["base"]["params"]["beams_swapped"] is True
    assert ("# why" in layout) == ("# why" in file.read_text(encoding="utf-8"))


def test_a_layout_that_is_not_understood_is_left_alone(tmp_path):
    file = tmp_path / "robot.toml"
    text = '[component]\nhead = { run = "h" }\nbase = { run = "b" }\n'
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError, match="paste"):
        write(file, PATCHES)
    assert file.read_text(encoding="utf-8") == text


def test_literals_read_back():
    value = {"a": True, "b": -1.5, "c": 'x"y\\', "d": ["p", 2], "e": {"f": 1e-07}}
    assert tomllib.loads(f"value = {literal(value)}")["value"] == value
