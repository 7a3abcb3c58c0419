"""The whole system, every component a process on the bus: it runs, it stops, and it survives being shot at."""

import json
import os
import secrets
import signal
import time
from collections import defaultdict
from pathlib import Path

import pytest

from benchmarks.watched import START_S, Watched, is_alive, wait_until, watched
from runtime.launch import load
from runtime.recording import Recording
from runtime.system import ports_of
from schemas.drive_pb2 import BaseCommand
from tests.recorded_session import LAUNCH

pytestmark = pytest.mark.xdist_group("live")
NAMES = {spec.name for spec in load(LAUNCH, recording=Path("none.mcap")).components}
SUMMARY = (
    "robot_s",
    "wall_s",
    "messages",
    "lost",
    "refused",
    "trials",
    "docked",
    "picked",
    "collisions",
    "recording",
    "report",
    "exit_reason",
)
GONE_S = 6.0
"""Two seconds are asked for (`benchmarks.stopping` measures them); a test machine may be busy."""


def realm() -> str:
    return f"test/{secrets.token_hex(6)}"


def drive(directory: Path, *more: str):
    """A system in real time whose robot is about to drive."""
    return watched(directory, realm(), ("--clock", "real", "--record", str(directory / "live.mcap"), *more))


def await_driving(system: Watched) -> None:
    assert wait_until(lambda: system.seen.drives() or system.process.poll() is not None, START_S), system.told()
    assert set(system.look()) == NAMES


def commands(recording: Path) -> list[BaseCommand]:
    return [logged.decoded() for logged in Recording(recording).messages({"base/actuate"})]


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    """A robot-minute in lockstep, run to its end: (summary, exit code, recording, processes)."""
    directory = tmp_path_factory.mktemp("minute")
    file = directory / "minute.mcap"
    words = ("--duration", "60", "--set", "pilot.train_s=35", "--record", str(file))
    with watched(directory, realm(), words) as system:
        assert wait_until(lambda: system.seen.truths or system.process.poll() is not None, START_S)
        pids = system.look()
        code, out, err = system.end(180)
    assert code == 0, err
    return json.loads(out), pids, file


def test_a_robot_minute_on_the_bus_is_complete(session):
    summary, pids, file = session
    assert tuple(summary) == SUMMARY
    assert summary["exit_reason"] == "duration"
    assert summary["lost"] == 0
    assert summary["robot_s"] == pytest.approx(60, abs=20)  # the supervisor looks ten times a second of wall time
    assert summary["trials"] >= 1
    assert summary["recording"] == str(file)
    assert Recording(file).whole()
    assert set(pids) == NAMES
    assert not any(map(is_alive, pids.values()))


def test_a_robot_minute_has_its_report_beside_the_recording(session):
    summary, _, file = session
    assert summary["report"] == str(file.with_suffix(".html"))
    assert file.with_suffix(".html").read_text(encoding="utf-8").startswith("<!doctype html>")


def test_the_recording_has_everything_that_was_said(session):
    summary, _, file = session
    sequences = defaultdict(list)
    for logged in Recording(file).messages():
        sequences[logged.topic, logged.run].append(logged.sequence)
    assert all(found == list(range(len(found))) for found in sequences.values())
    assert sum(map(len, sequences.values())) == pytest.approx(summary["messages"], abs=100)
    assert len({run for _, run in sequences}) == len(NAMES), "a run id for each process"


def test_on_the_bus_every_frame_is_answered_once(session):
    _, _, file = session
    stamps = defaultdict(list)
    for logged in Recording(file).messages():
        stamps[logged.topic].append(logged.capture_ns)
    shown = stamps["camera/image"]
    for spec in load(LAUNCH).components:
        for port, declared in ports_of(spec.run).OUTPUTS.items():
            if declared.per_frame:
                found = [stamp for stamp in stamps[spec.outputs[port]] if stamp < shown[-2]]
                assert found == shown[:-2], "base says its stop in one of the last two frames: " + spec.outputs[port]


def test_control_c_stops_everything_at_rest_with_a_complete_recording(tmp_path):
    with drive(tmp_path) as system:
        await_driving(system)
        system.process.send_signal(signal.SIGINT)
        assert wait_until(lambda: not system.left(), GONE_S), system.left()
        asked_ns = system.seen.first_zero(0)
        code, out, err = system.end(30)
    assert asked_ns is not None
    assert code == 0, err
    assert json.loads(out)["exit_reason"] == "interrupted"
    assert Recording(tmp_path / "live.mcap").whole()
    last = commands(tmp_path / "live.mcap")[-1]
    assert (last.v_mps, last.omega_radps) == (0.0, 0.0)
    assert not list((tmp_path / "run" / "berth").glob("*.run.json"))


@pytest.mark.parametrize("name", ["pilot", "vision", "simulator"])
def test_base_stops_by_itself_when_another_is_killed(tmp_path, name):
    """The supervisor is frozen meanwhile: base alone must see it."""
    with drive(tmp_path) as system:
        await_driving(system)
        system.process.send_signal(signal.SIGSTOP)
        killed_ns = system.kill(name)
        assert wait_until(lambda: system.seen.first_zero(killed_ns), 2.0)
        if name != "simulator":
            assert wait_until(system.seen.rests, 3.0)
        assert set(system.left()) == NAMES - {name}
        system.process.send_signal(signal.SIGCONT)
        ends_badly(system, name)
    recording = Recording(tmp_path / "live.mcap")
    assert recording.whole()
    reasons = {logged.decoded().commander for logged in recording.messages({"base/applied"})}
    assert "gone" in reasons, "by liveliness, not for want of a command"
    last = commands(tmp_path / "live.mcap")[-1]
    assert (last.v_mps, last.omega_radps) == (0.0, 0.0)


def test_a_robot_whose_base_process_is_killed_stops_by_its_own_watchdog(tmp_path):
    with drive(tmp_path) as system:
        await_driving(system)
        system.process.send_signal(signal.SIGSTOP)
        killed_ns = system.kill("base")
        assert wait_until(system.seen.rests, 4.0)
        assert not any(seen.at_ns > killed_ns + 50_000_000 for seen in system.seen.commands)
        system.process.send_signal(signal.SIGCONT)
        ends_badly(system, "base")
    truths = [logged.decoded() for logged in Recording(tmp_path / "live.mcap").messages({"simulator/truth"})]
    assert truths[-1].v_mps == 0.0


def test_without_a_recorder_the_session_ends_and_the_file_is_readable(tmp_path):
    with drive(tmp_path) as system:
        await_driving(system)
        killed_ns = system.kill("recorder")
        assert wait_until(lambda: system.seen.first_zero(killed_ns), GONE_S)
        ends_badly(system, "recorder")
        origin_ns = min(seen.at_ns - seen.capture_ns for seen in system.seen.truths)
    recording = Recording(tmp_path / "live.mcap")
    assert not recording.whole()
    newest_ns = max(logged.time_ns for logged in recording.messages())
    assert killed_ns - origin_ns - newest_ns < 3e9, "flushed each second; the recorder of a busy machine is late"


def ends_badly(system: Watched, victim: str) -> None:
    assert wait_until(lambda: not system.left(), GONE_S), system.left()
    code, out, _ = system.end(30)
    assert code == 1
    assert json.loads(out)["exit_reason"] == f"{victim} was killed by SIGKILL"


def test_no_process_and_no_motion_outlives_a_killed_supervisor(tmp_path):
    with drive(tmp_path) as system:
        await_driving(system)
        killed_ns = time.monotonic_ns()
        os.kill(system.process.pid, signal.SIGKILL)
        assert wait_until(lambda: not system.left(), GONE_S), system.left()
    assert system.seen.first_zero(killed_ns) is not None or rests_in_file(tmp_path / "live.mcap")
    assert Recording(tmp_path / "live.mcap").whole()


def rests_in_file(recording: Path) -> bool:
    return (commands(recording)[-1].v_mps, commands(recording)[-1].omega_radps) == (0.0, 0.0)
