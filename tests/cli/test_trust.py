"""`berth run --shadow` and `berth compare`, in this process; failures in `berth info`."""

import json

import numpy as np
import pytest

from cli.policies import controller_and_file
from cli.shadow import with_shadow
from docking.cells import Grid
from docking.policy import PolicyTable
from docking.task import Task
from report.failures import Endings, counted
from report.session import read
from report.shadow import ShadowReader, longest
from runtime.launch import load
from runtime.log import LogWriter
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.wiring import wires
from schemas.drive_pb2 import Applied, Drive
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial
from tests.recorded_session import LAUNCH

FRAME_NS = 125_000_000


def turning(file, action):
    """A policy that turns one way everywhere, sure of the goal."""
    task = Task()
    grid = Grid.of(task)
    table = PolicyTable(grid, np.full(grid.count, action, np.int8), np.full(grid.count, 200.0), task.actions)
    file.write_bytes(table.to_bytes())
    return file


@pytest.fixture
def lefty(tmp_path):
    return turning(tmp_path / "lefty.policy", 0)


@pytest.fixture
def righty(tmp_path):
    return turning(tmp_path / "righty.policy", 1)


def test_nobody_is_wired_to_a_shadow_and_it_sees_what_the_pilot_sees(lefty):
    system = with_shadow(load(LAUNCH), str(lefty))
    shadow, pilot = system.component("shadow"), system.component("pilot")
    assert not [wire for wire in wires(system) if wire.source == "shadow"]
    assert shadow.inputs["percept"] == pilot.inputs["percept"]
    assert shadow.params["shadow"]
    assert not pilot.params["shadow"]
    assert {spec["name"] for spec in json.loads(system.text)["components"]} == {s.name for s in system.components}


def test_a_shadow_changes_nothing_that_is_driven_and_is_reported(run, tmp_path, righty):
    words = ["--in-process", "--duration", "6", "--set", "pilot.controller=lc", "--json"]
    alone, beside = tmp_path / "alone.mcap", tmp_path / "beside.mcap"
    assert run("run", LAUNCH, "--record", alone, *words)[0] == 0
    assert run("run", LAUNCH, "--record", beside, "--shadow", righty, *words)[0] == 0
    driven = [[m.payload for m in Recording(file).messages({"base/applied"})] for file in (alone, beside)]
    assert len(driven[0]) > 40
    assert driven[0] == driven[1]
    _, out, _ = run("info", beside, "--json")
    shadow = json.loads(out)["shadow"]
    assert shadow["frames"] > 20
    assert shadow["agree_percent"] < 50
    assert shadow["longest_differences"][0]["shadow_degps"] == -10.0
    assert run("replay", beside, "--component", "shadow", "--check")[0] == 0


def test_two_policies_take_turns_from_the_same_starts_until_it_is_decided(run, tmp_path, lefty):
    session = tmp_path / "compared.mcap"
    code, out, _ = run("compare", "lc", lefty, "--in-process", "--pairs", "20", "--record", session, "--json",
                       "--alpha", "0.9", "--set", "pilot.pick_up=false", "--launch", LAUNCH)  # fmt: skip
    table = json.loads(out)
    assert (code, table["exit_reason"], table["better"]) == (0, "decided", "a")
    assert (table["only_a"], table["only_b"]) == (2, 0)
    assert 2 <= table["pairs"] < 20
    assert table["b"]["failures"] == {"model wrong": table["b"]["trials"]}
    placed = [m.decoded() for m in Recording(session).messages({"pilot/trial"}) if m.decoded().place]
    assert [trial.start for trial in placed[:4]] == [0, 0, 1, 1]
    assert [failed.side for failed in read(session).failed].count("b") == table["b"]["trials"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["run", LAUNCH, "--shadow", "nowhere"], "--shadow must be lc or a policy file; got 'nowhere'"),
        (["run", LAUNCH, "--shadow", LAUNCH], "holds no policy"),
        (["compare", "lc", "nowhere"], "B must be lc or a policy file"),
        (["compare", "learner", "lc"], "learner is still learning"),
        (["compare", "lc", "lc", "--alpha", "2"], "--alpha must be between 0 and 1"),
        (["compare", "lc", "lc", "--reset", "magic"], "evaluation_reset must be one of place, reverse"),
        (["compare", "lc", "lc", "--launch", "launch/look.toml"], "must have a component that runs"),
    ],
)
def test_what_can_not_be_compared_is_said_in_one_line(run, words, said):
    code, out, err = run(*words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err


def test_an_empty_file_is_no_policy(tmp_path):
    (tmp_path / "empty").write_bytes(b"")
    with pytest.raises(ConfigurationError, match="holds no policy"):
        controller_and_file(str(tmp_path / "empty"), "A")


def logged(tmp_path, frames):
    """A session with a shadow, of (commander, mode, driven, shadow) per frame."""
    system = with_shadow(load(LAUNCH), "lc")
    file = tmp_path / "shadow.mcap"
    log = LogWriter(file, system, started="")
    for k, (commander, mode, driven, shadow) in enumerate(frames):
        messages = {
            "pilot/trial": Trial(mode=mode),
            "shadow/trial": Trial(mode=Trial.APPROACH),
            "shadow/drive": Drive(omega_radps=shadow),
            "base/applied": Applied(commander=commander, omega_radps=driven),
            "tracker/percept": Percept(visible=True, slope=0.1, pan_rad=0.2, tilt_rad=0.5),
        }
        for topic, message in messages.items():
            name = message.DESCRIPTOR.full_name
            log.write(topic, name, message.SerializeToString(), 1, k, k * FRAME_NS, k * FRAME_NS)
    log.close()
    return Recording(file)


def compared(recording):
    reader = ShadowReader(recording.launch())
    for logged in recording.messages():
        if reader.wants(logged.topic):
            reader.take(logged, logged.decoded())
    return reader


def test_only_frames_in_which_somebody_drove_by_choice_are_compared(tmp_path):
    frames = [("pilot", Trial.APPROACH, 0.1, 0.1), ("teleop", Trial.WAIT, 0.1, 0.1), ("pilot", Trial.REVERSE, 0.1, 0.1),
              ("none", Trial.APPROACH, 0.0, 0.1), ("grasper", Trial.GRASP, 0.0, 0.1)]  # fmt: skip
    assert [round(frame.time_s / 0.125) for frame in compared(logged(tmp_path, frames)).frames] == [0, 1]


def test_a_stretch_of_disagreement_has_its_beginning_its_end_and_what_both_would_do(tmp_path):
    frames = [("pilot", Trial.APPROACH, 0.17, 0.17 if k < 8 or k > 15 else -0.17) for k in range(24)]
    reader = compared(logged(tmp_path, frames))
    (row,) = reader.table()["longest_differences"]
    assert (row["from_s"], row["to_s"]) == (1.0, 1.875)
    assert (row["driven_degps"], row["shadow_degps"]) == (9.7, -9.7)
    assert reader.table()["agree_percent"] == pytest.approx(100 * 16 / 24, abs=0.1)
    assert [len(stretch) for stretch in longest(reader.frames)] == [8]


def test_a_session_without_a_shadow_has_none():
    assert ShadowReader({"components": [{"name": "pilot", "params": {"shadow": False}}]}).table() == {}
    assert ShadowReader({"components": "nonsense"}).table() == {}


def test_failures_are_told_once_each_with_their_time():
    endings = Endings()
    for k, ended in enumerate((0, 0, 1, 1, 1, 2, 2)):
        failure = (Trial.NO_FAILURE, Trial.SLIP, Trial.OBJECT_LOST)[ended]
        endings.take(Trial(ended=ended, failure=failure, failure_ns=k * 10**9, outcome=Trial.LOST), k * 10**9)
    assert [(failed.name, failed.at_s) for failed in endings.failed] == [("slip", 2.0), ("object lost", 5.0)]
    assert counted(endings.failed) == {"slip": 1, "object lost": 1}
