"""Bad input of every verb: one line that names file, key, value and rule, exit code 2, nothing left running."""

import os
import secrets
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.watched import children
from cli.main import main
from runtime.runfile import claim, running
from tests.recorded_session import LAUNCH

TEXT = LAUNCH.read_text(encoding="utf-8")


@pytest.fixture
def mistake(monkeypatch, capsys, tmp_path):
    """Calls the command line; returns its one line."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.chdir(tmp_path)

    def call(*words: object) -> str:
        monkeypatch.setattr(sys, "argv", ["berth", *map(str, words)])
        with pytest.raises(SystemExit) as exit_:
            main()
        out, err = capsys.readouterr()
        assert exit_.value.code == 2, err
        assert out == ""
        assert err.count("\n") == 1
        assert err.startswith("berth: ")
        assert running() == []
        if Path(f"/proc/{os.getpid()}/task/{os.getpid()}/children").exists():
            assert not set(children(os.getpid())) & {"base", "simulator", "recorder"}
        return err

    return call


def launch_file(directory: Path, old: str = "", new: str = "") -> Path:
    """`launch/sim.toml` with one thing wrong."""
    assert old in TEXT
    file = directory / "wrong.toml"
    file.write_text(TEXT.replace(old, new, 1) if old else new, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('"components.vision"', '"components.visoin"', ("vision.run", "components.visoin", "ports.py")),
        ('run = "components.vision"', "", ("vision.run", "must be a text")),
        (
            '{ image = "camera/image" }\n',
            '{ image = "camera/imgae" }\n',
            ("vision.inputs.image", "published", "camera/imgae"),
        ),
        ('"camera/image" }   #', '"vision/view" } #', ("vision.outputs.view", "must not share a key", "'vision/view'")),
        (', device = "simulator/head" }', " }", ("head.inputs.device", "is missing", "HeadState")),
        ('"simulator/head" }', '"simulator/base" }', ("head.inputs.device", "berth.HeadState", "berth.BaseState")),
        ('"tracker/percept", trial', '"simulator/truth", trial', ("learner.inputs.percept", "evaluation only")),
        ('aim = "tracker/aim"', 'aimm = "tracker/aim"', ("head.inputs.aimm", "known are aim")),
        ('"tracker/aim"', '"tracker"', ("head.inputs.aim", '"component/port"', "'tracker'")),
        ('clock = "lockstep"', 'clock = "fast"', ("session.clock", "lockstep, real or a factor > 0", "'fast'")),
        ("seed = 1", "seed = -1", ("session.seed", "whole number >= 0", "-1")),
        ("stall_s = 10.0", "stall_s = 0", ("session.stall_s", "> 0", "got 0")),
        ("stall_s = 10.0", "stall = 1", ("session.stall ", "unknown", "stall_s")),
        ('end = "pilot/end"', 'end = "pilot/ned"', ("session.end", "published", "pilot/ned")),
        ("[task]", "[task]\nspeed_mps = -1", ("params.task.speed_mps", "> 0", "-1")),
        ("[task]", "[tasks]", ("tasks is unknown", "task, component")),
        ('"berth/sim"', '"berth//sim"', ("realm", "words joined by /", "berth//sim")),
        ("params = { stop", "params = { max_age_s = 'x', stop", ("base.params.max_age_s", "number", "'x'")),
        ("params = { stop", "params = { max_age_s = 9, stop", ("base.params.max_age_s", "between 0.05 and 2", "9.0")),
        ("params = { stop", "params = { max_age_s = nan, stop", ("base.params.max_age_s", "finite", "nan")),
        ("params = { stop", "params = { max_aeg_s = 1, stop", ("base.params.max_aeg_s", "unknown", "max_age_s")),
        ('restart = "on-failure"', 'restart = "often"', ("learner.restart", "never, on-failure, always", "'often'")),
        ("", "realm =", ("is not TOML",)),
        ("", "realm = 'a'", ("component", "at least one")),
    ],
)
@pytest.mark.parametrize("verb", ["run", "graph"])
def test_a_mistake_in_a_launch_file_names_key_value_and_rule(mistake, tmp_path, verb, old, new, named):
    file = launch_file(tmp_path, old, new)
    line = mistake(verb, file)
    assert f"berth: {file}: " in line
    assert all(word in line for word in named), line


@pytest.mark.parametrize("verb", ["run", "graph", "check"])
def test_a_launch_file_that_can_not_be_read_is_named(mistake, tmp_path, verb):
    assert "none.toml: can not be read: No such file or directory" in mistake(verb, "none.toml")
    assert f"{tmp_path}: can not be read: Is a directory" in mistake(verb, tmp_path)
    (tmp_path / "latin.toml").write_bytes(b"realm = '\xe9'")
    assert "latin.toml: is not TOML" in mistake(verb, "latin.toml")


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("--only", "vision,nobody"), ("component nobody is unknown", "simulator, vision")),
        (("--host", "laptop"), ("--host", "one of robot", "'laptop'")),
        (("--set", "nobody.x=1"), ("--set nobody.x=1", "component nobody is unknown")),
        (("--set", "pilot"), ("--set pilot", "COMPONENT.PARAM=VALUE")),
        (("--set", "pilot.trian_s=1"), ("pilot.params.trian_s", "unknown", "train_s")),
        (("--set", "pilot.train_s=soon"), ("pilot.params.train_s", "number", "'soon'")),
        (("--set", "pilot.train_s=-1"), ("pilot.params.train_s", ">= 0", "-1.0")),
        (("--set", "pilot.policy=none.npz"), ("pilot.params.policy", "readable file", "none.npz")),
        (("--set", "session.clock=-2"), ("session.clock", "-2")),
        (("--clock", "0"), ("session.clock", "factor > 0", "'0'")),
        (("--seed", "-3"), ("session.seed", ">= 0", "-3")),
        (("--seed", "few"), ("--seed",)),
        (("--duration", "-1"), ("--duration", ">= 0", "-1.0")),
        (("--duration", "nan"), ("--duration", "finite", "nan")),
        (("--duration", "long"), ("--duration",)),
        (("--recrod", "x"), ("--recrod",)),
        (("two", "words"), ("two",)),
    ],
)
def test_a_mistake_in_an_option_of_run_is_named(mistake, words, named):
    line = mistake("run", LAUNCH, *words)
    assert all(word in line for word in named), line


@pytest.mark.parametrize("how", [(), ("--in-process",)])
def test_a_recording_is_never_overwritten(mistake, tmp_path, how):
    (tmp_path / "mine.mcap").write_bytes(b"precious")
    line = mistake("run", LAUNCH, "--duration", "1", "--record", "mine.mcap", *how)
    assert "mine.mcap: must not exist yet; a recording is never overwritten" in line
    assert (tmp_path / "mine.mcap").read_bytes() == b"precious"


@pytest.mark.parametrize("how", [(), ("--in-process",)])
def test_a_recording_that_can_not_be_made_is_named(mistake, tmp_path, how):
    (tmp_path / "file").write_bytes(b"")
    assert "can not be made" in mistake("run", LAUNCH, "--duration", "1", "--record", "file/x.mcap", *how)


def test_a_realm_that_runs_already_is_refused(mistake, tmp_path):
    realm = f"test/{secrets.token_hex(6)}"
    file = launch_file(tmp_path, '"berth/sim"', f'"{realm}"')
    with claim(realm, "tcp/127.0.0.1:1", "", "elsewhere.toml", (), {}):
        words = [sys.executable, "-m", "cli.main", "run", str(file), "--no-record"]
        done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False, cwd=LAUNCH.parent.parent)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.splitlines()[-1] == f"berth: {file}: realm must not run yet; got '{realm}', see `berth ps`"
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("verb", ["info", "report"])
@pytest.mark.parametrize(
    ("content", "says"),
    [
        (None, "can not be read"),
        (b"", "must be an MCAP file"),
        (b"hello, world", "must be an MCAP file"),
        (b"\x89MCAP0\r\n", "must be a session of ours"),
        (b"\x89MCAP0\r\n" * 3, "must be a session of ours"),
        (b"\x89MCAP0\r\n" + b"\xff" * 64, "must be a session of ours"),
        (b"\x89MCAP0\r\n\x01\xff\xff\xff\xff\xff\xff\xff\x7f", "must be a session of ours"),
    ],
)
def test_a_file_that_is_no_session_is_refused(mistake, tmp_path, verb, content, says):
    if content is not None:
        (tmp_path / "foreign.mcap").write_bytes(content)
    line = mistake(verb, "foreign.mcap")
    assert "foreign.mcap: " in line
    assert says in line


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (("launch",), "launch"),
        (("run",), "launch"),
        (("graph",), "launch"),
        (("info",), "file"),
        (("check", "--duration", "0"), "--duration"),
        (("stop", "--realm", "no/such"), "realm no/such must be running"),
        (("topic", "echo", "a/b"), "nothing is running"),
        (("logs",), "must have run on this host"),
    ],
)
def test_every_verb_says_in_one_line_what_it_lacks(mistake, words, named):
    assert named in mistake(*words)
