"""`berth play` as a process: keys, looking on, standing in for a camera in real time, and what is refused."""

import itertools
import json
import os
import pty
import sys
import time

import pytest

from cli.main import main
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.runfile import find
from runtime.supervise import Supervisor
from tests.cli.running import DEADLINE_S, Ear, berth, by_key, finish, messages, told
from tests.runtime.system import recorded_system, run_until

pytestmark = pytest.mark.xdist_group("live")
FRAMES = 40


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A session of world and echo whose clock is real, ten times as fast."""
    system = recorded_system(tmp_path_factory.mktemp("log"), [f"world.frames={FRAMES}"], clock="10")
    with Supervisor(system) as supervisor:
        run_until(supervisor)
        supervisor.stop()
    assert supervisor.exit_code == 0
    return system


def await_realm(realm):
    deadline_s = time.monotonic() + DEADLINE_S
    while True:
        try:
            return find(realm)
        except ConfigurationError:
            assert time.monotonic() < deadline_s


def await_count(rows, count):
    deadline_s = time.monotonic() + DEADLINE_S
    while len(rows) < count:
        assert time.monotonic() < deadline_s, len(rows)


def test_keys_step_go_on_and_end_it_and_who_looks_sees_a_system(log):
    above, below = pty.openpty()
    playing = berth("play", log.recording, "-p", "-r", "100", "-x", "status", "--json", stdin=below)
    realm = f"replay/{log.realm}"
    ear = Ear(await_realm(realm), [key for key in find(realm).topics if key != "player/clock"])
    ear.start()
    clock = Ear(find(realm), ["player/clock"])
    clock.start()
    await_count(clock.rows, 1)
    wanted = [row for row in messages(log.recording) if not row.topic.endswith("status")]
    for count in (1, 2, 3):
        os.write(above, b"." if count % 2 else b"\x1b[C")
        await_count(ear.rows, count)
    assert len(ear.rows) == 3
    topics = told(berth("topic", "list", "--realm", realm, "--json"))
    assert topics == {**{row.topic: row.schema for row in wanted}, "player/clock": "berth.Playback"}
    os.write(above, b" ")
    table = told(playing)
    ear.finish()
    clock.finish()
    assert [(row.topic, row.payload) for row in ear.rows] == [(row.topic, row.payload) for row in wanted]
    assert (table["played"], table["exit_reason"]) == (len(wanted), "end of the log")
    os.close(above)
    os.close(below)


def test_q_ends_it(log):
    above, below = pty.openpty()
    playing = berth("play", log.recording, "-p", "--json", stdin=below)
    await_realm(f"replay/{log.realm}")
    os.write(above, b"q")
    assert told(playing)["exit_reason"] == "quit"
    os.close(above)
    os.close(below)


def test_it_ends_when_its_terminal_has_gone(log):
    above, below = pty.openpty()
    playing = berth("play", log.recording, "-p", "--json", stdin=below)
    os.close(below)
    await_realm(f"replay/{log.realm}")
    clock = Ear(find(f"replay/{log.realm}"), ["player/clock"])
    clock.start()
    await_count(clock.rows, 1)  # it has its terminal and plays
    os.close(above)
    assert told(playing)["exit_reason"] == "the terminal has gone"
    clock.finish()


def test_a_log_stands_in_for_the_camera_of_a_running_system_in_real_time(log, tmp_path):
    system = recorded_system(tmp_path, clock="real", only=("echo", "recorder"))
    with Supervisor(system) as supervisor:
        words = ["--replace", "world", "--realm", system.realm, "--start-offset", "1", "--duration", "2", "--json"]
        playing = berth("play", log.recording, *words)
        run_until(supervisor, lambda: playing.poll() is not None)
        table = told(playing)
        supervisor.stop()
    assert [status.malformed for status in supervisor.statuses.values()] == [0, 0]
    found = by_key(messages(system.recording))
    images = found["world/image"]
    assert len(images) == table["played"] > 10
    ages_s = sorted((row.time_ns - row.capture_ns) / 1e9 for row in images)
    assert ages_s[0] >= -0.01
    assert ages_s[len(ages_s) // 2] < 1.0  # as old as when they were recorded, on this system's clock
    periods_s = [(b.capture_ns - a.capture_ns) / 1e9 for a, b in itertools.pairwise(images)]
    assert sorted(periods_s)[len(periods_s) // 2] == pytest.approx(0.125, abs=0.02)
    assert [row.capture_ns for row in found["echo/drive"]][: len(images)] == [row.capture_ns for row in images]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["no/such.mcap"], "no/such.mcap: can not be read"),
        (["LOG", "--remap", "world/image"], "--remap must be OLD:=COMPONENT/PORT; got 'world/image'"),
        (["LOG", "--remap", "world/image:=a/**"], "--remap must be OLD:=COMPONENT/PORT"),
        (["LOG", "--topics", "a/b"], "--topics must be keys of"),
        (["LOG", "--start-offset", "1000"], "must hold messages of these from 1000 s on"),
        (["LOG", "--start-offset", "1e300"], "'--start-offset'"),
        (["LOG", "--duration", "inf"], "'--duration'"),
        (["LOG", "--rate", "inf"], "'--rate'"),
        (["LOG", "--realm", "a/*"], "--realm must be words joined by /; got 'a/*'"),
        (["LOG", "--replace", "world", "--realm", "no/such"], "realm no/such must be running"),
        (["LOG", "--replace", "world", "--fast", "--realm", "IDLE"], "--rate must be > 0 in"),
        (["LOG", "--replace", "echo", "--realm", "IDLE"], "--replace echo: must not run in"),
        (["LOG", "--replace", "ghost", "--realm", "IDLE"], "must hold messages of ghost"),
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(log, idle, monkeypatch, capsys, words, said):
    names = {"LOG": str(log.recording), "IDLE": idle}
    monkeypatch.setattr(sys, "argv", ["berth", "play", *(names.get(word, word) for word in words)])
    with pytest.raises(SystemExit) as end:
        main()
    out, err = capsys.readouterr()
    assert (end.value.code, out, err.count("\n")) == (2, "", 1)
    assert said in err


@pytest.fixture(scope="module")
def idle(tmp_path_factory):
    """Realm of a system in real time that runs without its world."""
    system = recorded_system(tmp_path_factory.mktemp("idle"), clock="real", only=("echo", "recorder"))
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: not supervisor.missing)
        yield system.realm


def test_a_torn_log_is_played_up_to_its_tear(log, tmp_path):
    torn = tmp_path / "torn.mcap"
    data = log.recording.read_bytes()
    torn.write_bytes(data[: len(data) * 2 // 3])
    code, out, _ = finish(berth("play", torn, "--fast", "--realm", f"{log.realm}/torn", "--json"))
    assert code == 0
    assert json.loads(out)["played"] == len(list(Recording(torn).messages())) > 0
