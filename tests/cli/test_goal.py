"""The goal shown to a simulated robot whose camera is 5 cm aside and yawed 3 deg: taught, refused, and driven to."""

import json
import sys
import tomllib

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.goal import ASIDE, STANDING, linear_law
from cli.goal import goal
from cli.main import main
from cli.sight import eyes
from docking.angles import DEG
from docking.task import Task
from report.session import read
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.recording import Recording
from tests.recorded_session import LAUNCH, record
from tests.runtime.offline import rewritten, without

HEAD_DOWN = ("simulator.home_tilt_rad=1.0", "tracker.home_tilt_rad=1.0")
"""The object is in view from the start: no search."""
DRIVING = LAUNCH.parent.parent / "recordings" / "docking.mcap"


@pytest.fixture(scope="module")
def standing(tmp_path_factory):
    """A session of ten seconds in the pick-up pose."""
    file = tmp_path_factory.mktemp("standing") / "standing.mcap"
    record(file, [*STANDING, *ASIDE, *HEAD_DOWN], duration_s=10.0)
    return file


def teach(*words):
    """Standard output of `berth goal teach`, in this process; what it refuses is raised."""
    done = CliRunner().invoke(goal, ["teach", *map(str, words)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    assert done.exit_code == 0
    return done.stdout


def test_a_recording_of_the_pick_up_pose_gives_a_goal_that_knows_where_the_camera_is(standing, tmp_path):
    table = json.loads(teach("--from", standing, "-o", tmp_path / "goal.toml", "--json"))
    assert (table["seen"], table["frames"]) == (40, 40)
    assert table["camera"]["yaw_rad"] / DEG == pytest.approx(3.0, abs=0.5)
    assert 0.45 * table["camera"]["left_of_axis_per_height"] == pytest.approx(0.05, abs=0.005)
    assert tomllib.loads((tmp_path / "goal.toml").read_text(encoding="utf-8")) == table["task"]


def test_with_the_taught_goal_of_a_camera_aside_the_linear_law_docks_and_the_report_reads_bearings_from_the_axle(
    standing, tmp_path
):
    """A short version of `python -m benchmarks goal`; without the goal none of these starts docks."""
    goal_file, driven = tmp_path / "goal.toml", tmp_path / "driven.mcap"
    teach("--from", standing, "-o", goal_file)
    record(driven, [*linear_law(), *ASIDE, "pilot.train_s=0", "pilot.evaluation_trials=4", f"pilot.task={goal_file}"])
    session = read(driven)
    assert [(trial.docked, trial.picked, trial.collided) for trial in session.trials] == [(True, True, False)] * 4
    assert np.percentile(session.bearing_error_rad, 95) < 2 * DEG


def test_the_frames_are_those_from_the_second_asked_for(standing, tmp_path):
    frames = [row.capture_ns for row in Recording(standing).messages(["tracker/percept"])]
    table = json.loads(teach("--from", standing, "--at", 7.5, "--frames", 16, "-o", tmp_path / "a.toml", "--json"))
    assert table["at_s"] == min(ns for ns in frames if ns >= 7.5e9) / 1e9
    again = json.loads(
        teach("--from", standing, "--at", table["at_s"], "--frames", 16, "-o", tmp_path / "b.toml", "--json")
    )
    assert again["mean"] == table["mean"]


def refused(*words):
    with pytest.raises(ConfigurationError) as error:
        teach(*words)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_what_is_no_goal_is_refused_and_writes_nothing(standing, tmp_path):
    file = tmp_path / "goal.toml"
    blind = rewritten(standing, tmp_path / "blind.mcap", without("tracker/percept"))
    assert "at least 16 frames; got 8" in refused("--from", standing, "--at", "9.01", "-o", file)
    assert "in 80 % of the frames" in refused("--from", standing, "--at", "0", "-o", file)  # the lens is being learned
    assert "must not spread by more than" in refused("--from", DRIVING, "--at", "10", "-o", file)
    assert "must hold percepts; there are none" in refused("--from", blind, "-o", file)
    assert not file.exists()


def test_a_file_that_is_there_is_kept(standing, tmp_path):
    file = tmp_path / "goal.toml"
    file.write_text("mine", encoding="utf-8")
    assert "must not exist yet" in refused("--from", standing, "-o", file)
    assert file.read_text(encoding="utf-8") == "mine"
    (tmp_path / "file").touch()
    assert "can not be written" in refused("--from", standing, "-o", tmp_path / "file" / "goal.toml")


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("--from", "none.mcap"), "none.mcap: can not be read"),
        ((LAUNCH, "--from", "none.mcap"), "--from must stand alone"),
        (("--at", "3"), "--at must stand with --from"),
        (("--from", "none.mcap", "--at", "nan"), "--at must be >= 0 and finite; got nan"),
        (("--set", "pilot.train_s=1"), "--set must stand with a launch file"),
        ((LAUNCH,), "a key must be pressed on a terminal; without one use --now"),
        ((LAUNCH, "--now", "--set", "pilot.trian_s=1"), "pilot.params.trian_s is unknown"),
    ],
)
def test_a_mistake_is_one_line(words, named, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert named in refused(*words)
    assert not list(tmp_path.glob("*.toml"))


def test_the_command_ends_with_2_on_a_refusal(standing, tmp_path, monkeypatch, capsys):
    words = ["berth", "goal", "teach", "--from", str(standing), "--at", "9.9", "-o", str(tmp_path / "goal.toml")]
    monkeypatch.setattr(sys, "argv", words)
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert capsys.readouterr().err.startswith("berth: no goal: there must be at least 16 frames")


def test_nobody_who_can_move_the_wheels_is_started():
    assert eyes(load(LAUNCH)) == ["simulator", "vision", "head", "tracker"]


def test_the_eyes_alone_show_the_goal_and_it_is_the_default_one_for_a_camera_on_the_axis(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    sets = [word for value in (*HEAD_DOWN, "session.clock=4") for word in ("--set", value)]
    table = json.loads(teach(LAUNCH, "--now", "--frames", 16, *sets, "--json"))
    goal_tilt = table["task"]["goal_tilt_rad"]
    assert goal_tilt == pytest.approx(Task().goal_tilt_rad, abs=0.3 * DEG)
    assert [table["task"]["goal_slope"], table["task"]["goal_pan_rad"]] == pytest.approx([0.0, 0.0], abs=0.01)
    again = json.loads(
        teach("--from", table["from"], "--at", table["at_s"], "--frames", 16, "-o", tmp_path / "again.toml", "--json")
    )
    assert again["mean"] == pytest.approx(table["mean"], abs=0.002)  # a busy bus may drop a percept for either listener
