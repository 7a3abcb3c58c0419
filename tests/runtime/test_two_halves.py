"""Two supervisors are the two hosts of one system, joined by a link on loopback; their clocks differ by ten seconds."""

import os
import secrets
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import NamedTuple

import pytest

from runtime import supervise
from runtime.bus import free_endpoint, open_observer
from runtime.launch import load
from runtime.link import Link
from runtime.params import ConfigurationError
from runtime.presence import STARTS
from runtime.supervise import Supervisor
from runtime.system import System
from schemas.drive_pb2 import BaseCommand
from tests.runtime.system import DEADLINE_S, heard

pytestmark = pytest.mark.xdist_group("live")
OFFSET_NS = 10_000_000_000


class Pair(NamedTuple):
    """The halves of a system and where they meet."""

    robot: System
    laptop: System
    endpoint: str


def pair(directory: Path, frames: int = 0, clock: str = "real") -> Pair:
    """World and echo on the robot, student and witness on the laptop."""
    file = directory / "two.toml"
    file.write_text(
        f"""
realm = "test/{secrets.token_hex(6)}"
[session]
clock = "{clock}"
end = "world/end"
[component.world]
run = "tests.runtime.parts.world"
inputs = {{ drive = "echo/drive", ack = "witness/ack" }}
params = {{ frames = {frames} }}
[component.echo]
run = "tests.runtime.parts.echo"
inputs = {{ image = "world/image" }}
[component.student]
run = "tests.runtime.parts.student"
host = "laptop"
inputs = {{ image = "world/image" }}
[component.witness]
run = "tests.runtime.parts.witness"
host = "laptop"
""",
        encoding="utf-8",
    )
    recording = directory / "heard.jsonl"
    halves = [load(file, host=host, recording=recording) for host in ("robot", "laptop")]
    return Pair(*halves, free_endpoint())


@contextmanager
def on(
    host: str, pair: Pair, directory: Path, monkeypatch, ahead_ns: int = 0, link: Link | None = None
) -> Iterator[Supervisor]:
    """One host's half, with run files of its own; its session time is ahead by so much."""
    home = directory / f"{host}-{secrets.token_hex(3)}"
    home.mkdir(mode=0o700)
    system, plain = (pair.robot, Link(pair.endpoint)) if host == "robot" else (pair.laptop, Link("", pair.endpoint))
    supervisor = Supervisor(system, link=link or plain)
    now_ns = time.monotonic_ns
    with monkeypatch.context() as patched:
        patched.setenv("XDG_RUNTIME_DIR", str(home))
        patched.setattr(supervise.time, "monotonic_ns", lambda: now_ns() - ahead_ns)
        supervisor.__enter__()
    try:
        yield supervisor
    finally:
        supervisor.stop()


def follow(condition, *supervisors: Supervisor) -> None:
    """Look after both halves until a condition holds."""
    deadline_s = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < deadline_s, [(s.missing, s.statuses, s.end_reason) for s in supervisors]
        for supervisor in supervisors:
            supervisor.poll(0.01)


def handled(supervisor: Supervisor, name: str) -> int:
    status = supervisor.statuses.get(name)
    return status.handled if status is not None else 0


@pytest.mark.parametrize("ahead", ["robot", "laptop"])
def test_clocks_ten_seconds_apart_break_nothing(tmp_path, monkeypatch, ahead):
    both = pair(tmp_path)
    ahead_ns = {host: OFFSET_NS if host == ahead else 0 for host in ("robot", "laptop")}
    with (
        on("robot", both, tmp_path, monkeypatch, ahead_ns["robot"]) as robot,
        on("laptop", both, tmp_path, monkeypatch, ahead_ns["laptop"]) as laptop,
    ):
        follow(lambda: handled(laptop, "student") > 10 and handled(robot, "echo") > 10, robot, laptop)
        assert set(robot.pids) == {"world", "echo"}
        assert set(laptop.pids) == {"student", "witness"}
    for status in (*robot.statuses.values(), *laptop.statuses.values()):
        assert (status.malformed, status.lost, status.note) == (0, 0, "")


def test_no_process_is_told_of_the_other_host_s_processes(tmp_path, monkeypatch):
    """Here they could be reached; on two machines another process would be behind the same loopback address."""
    both = pair(tmp_path)
    with on("robot", both, tmp_path, monkeypatch) as robot, on("laptop", both, tmp_path, monkeypatch) as laptop:
        follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        for half in (robot, laptop):
            with open_observer(half.run.endpoint) as session:
                follow(lambda info=session.info: len(info.peers_zid()) >= 2, robot, laptop)
                follow(_after(robot, 8), robot, laptop)
                assert len(session.info.peers_zid()) == len(half.pids) == 2
                assert len(session.info.routers_zid()) == 1


def _after(robot: Supervisor, frames: int) -> Callable[[], bool]:
    first = handled(robot, "echo")
    return lambda: handled(robot, "echo") > first + frames


def test_the_end_of_the_session_ends_both_halves_and_the_recording_has_the_last_word(tmp_path, monkeypatch):
    both = pair(tmp_path, frames=30, clock="lockstep")
    with on("robot", both, tmp_path, monkeypatch) as robot, on("laptop", both, tmp_path, monkeypatch) as laptop:
        follow(lambda: robot.end_reason and laptop.end_reason, robot, laptop)
        stop_together(robot, laptop)
    assert robot.end_reason == laptop.end_reason == "all frames shown"
    assert (robot.exit_code, laptop.exit_code) == (0, 0)
    rows = [row for row in heard(both.laptop) if row.key == "world/image"]
    assert [row.sequence for row in rows] == list(range(30))
    last = [row for row in heard(both.laptop) if row.key == "echo/drive"][-1]
    assert BaseCommand.FromString(last.payload).v_mps == -2.0, "what echo says at the stop"
    assert laptop.lost == robot.lost == 0


def stop_together(robot: Supervisor, laptop: Supervisor) -> None:
    other = Thread(target=robot.stop)
    other.start()
    laptop.stop()
    other.join()


def test_the_robot_goes_on_without_the_laptop_and_takes_a_new_one(tmp_path, monkeypatch):
    both = pair(tmp_path)
    with on("robot", both, tmp_path, monkeypatch) as robot:
        with on("laptop", both, tmp_path, monkeypatch) as laptop:
            follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        follow(lambda: robot.note, robot)
        assert robot.note == "laptop is away; robot goes on without it"
        before = handled(robot, "echo")
        follow(lambda: handled(robot, "echo") > before + 8, robot)
        with on("laptop", both, tmp_path, monkeypatch) as again:
            follow(lambda: handled(again, "student") > 3, robot, again)
            assert again.statuses["student"].lost == 0, "it was not there before: nothing is lost"
            assert (robot.note, robot.deaths) == ("", [])
    words = (Path(robot.run.directory) / "supervisor.log").read_text(encoding="utf-8")
    assert [line.partition(" ")[2] for line in words.splitlines()][:4] == [
        "laptop is there",
        "laptop has ended",
        "laptop is away; robot goes on without it",
        "laptop was started again and is there",
    ]


def test_the_laptop_ends_when_the_robot_ends_in_order(tmp_path, monkeypatch):
    both = pair(tmp_path)
    with on("laptop", both, tmp_path, monkeypatch) as laptop:
        with on("robot", both, tmp_path, monkeypatch) as robot:
            follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        follow(lambda: laptop.end_reason, laptop)
    assert (laptop.end_reason, laptop.exit_code) == ("robot has ended", 0)


def test_a_laptop_with_other_parameters_is_refused_and_the_robot_goes_on(tmp_path, monkeypatch):
    both = pair(tmp_path)
    other = load(both.laptop.file, ["session.seed=2"], host="laptop", recording=tmp_path / "other.jsonl")
    with on("robot", both, tmp_path, monkeypatch) as robot:
        with on("laptop", both, tmp_path, monkeypatch) as laptop:
            follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        with (
            on("laptop", both._replace(laptop=other), tmp_path, monkeypatch) as stranger,
            pytest.raises(ConfigurationError, match="host robot must run the same system"),
        ):
            follow(lambda: stranger.end_reason, stranger, robot)
        before = handled(robot, "echo")
        follow(lambda: handled(robot, "echo") > before + 8, robot)


def test_a_component_of_the_robot_is_started_again_while_the_laptop_is_away(tmp_path, monkeypatch):
    both = pair(tmp_path)
    text = (
        Path(both.robot.file)
        .read_text(encoding="utf-8")
        .replace('run = "tests.runtime.parts.echo"', 'run = "tests.runtime.parts.echo"\nrestart = "on-failure"')
    )
    Path(both.robot.file).write_text(text, encoding="utf-8")
    halves = [load(both.robot.file, host=host, recording=tmp_path / "heard.jsonl") for host in ("robot", "laptop")]
    both = Pair(*halves, both.endpoint)
    with on("robot", both, tmp_path, monkeypatch) as robot:
        with on("laptop", both, tmp_path, monkeypatch) as laptop:
            follow(lambda: handled(laptop, "student") > 3, robot, laptop)
        follow(lambda: robot.note, robot)
        os.kill(robot.pids["echo"], signal.SIGKILL)
        follow(lambda: robot.deaths, robot)
        follow(lambda: not robot._presence.runs(STARTS, "echo"), robot)
        follow(lambda: robot._presence.runs(STARTS, "echo"), robot)
        assert [death.restarted for death in robot.deaths] == [True]
