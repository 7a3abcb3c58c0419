"""A component that is started again goes on from its newest snapshot, live and in replay."""

import os
import signal
from collections import defaultdict
from pathlib import Path

import pytest

from runtime.hosted import Hosted
from runtime.journal import LOADED, entries
from runtime.launch import load
from runtime.recording import Recording
from runtime.replay import replay
from runtime.supervise import Supervisor
from schemas.drive_pb2 import BaseCommand
from schemas.session_pb2 import Journal, Snapshot
from tests.runtime.offline import rewritten, without
from tests.runtime.system import recorded_system, run_until

pytestmark = pytest.mark.xdist_group("live")


@pytest.fixture(scope="module")
def restarted(tmp_path_factory) -> Path:
    """A session whose scholar is killed when the recorder has had time to hear a snapshot, and started again."""
    directory = tmp_path_factory.mktemp("restarted")
    more = 'restart = "on-failure"\nparams = { every = 200 }  # it is killed long before the next one is under way'
    words = ["world.frames=0", "world.window=16"]
    system = recorded_system(directory, words, fold="scholar", echo=more, stall_s=0.5)
    supervisor = Supervisor(system)
    snapshots: list[int] = []
    supervisor.watch("scholar/snapshot", lambda snapshot, _: snapshots.append(snapshot.version))
    drives: list[int] = []
    supervisor.watch("scholar/drive", lambda *_: drives.append(len(snapshots)))
    with supervisor:
        run_until(supervisor, lambda: sum(map(bool, drives)) > 50)
        os.kill(supervisor.pids["scholar"], signal.SIGKILL)
        run_until(supervisor, lambda: bool(supervisor.deaths))
        known = len(snapshots)
        run_until(supervisor, lambda: len(snapshots) > known)
        supervisor.stop()
    assert supervisor.exit_code == 0
    return system.recording


def runs_of(file, topic) -> list[list]:
    found = defaultdict(list)
    for logged in Recording(file).messages([topic]):
        found[logged.run].append(logged)
    return list(found.values())


def test_it_goes_on_where_its_newest_snapshot_was_taken(restarted):
    first, second = runs_of(restarted, "scholar/journal")
    loaded = next(iter(entries([Journal.FromString(second[0].payload)])))
    assert (loaded.number, loaded.port, loaded.source_run) == (0, LOADED, first[0].run)
    taken = next(s for s in runs_of(restarted, "scholar/snapshot")[0] if s.sequence == loaded.source_sequence)
    drives = runs_of(restarted, "scholar/drive")
    before = next(d for d in drives[0] if d.capture_ns == taken.capture_ns)
    after = drives[1][0]
    sums = [BaseCommand.FromString(logged.payload).v_mps for logged in (before, after)]
    assert sums[1] == sums[0] + after.capture_ns / 1e9


def test_both_runs_are_replayed_to_the_byte(restarted):
    report = replay(Recording(restarted), "scholar")
    assert not report.differs
    assert len(report.runs) == 2
    assert report.runs[1].words == ""
    assert report.comparisons[1].identical > 8
    assert f"run {report.runs[1].run:016x} went on from a snapshot" in report.notes[0]


def test_the_recorded_snapshot_is_never_read(restarted, tmp_path):
    report = replay(Recording(rewritten(restarted, tmp_path / "x.mcap", without("scholar/snapshot"))), "scholar")
    assert report.runs[1].words == ""
    assert report.comparisons[1].identical > 8


def test_a_snapshot_that_the_former_run_does_not_give_again_is_named(restarted, tmp_path):
    def change(topic, message):
        return None if topic == "scholar/journal" and message.channel == first else message

    channels = []
    rewritten(restarted, tmp_path / "look.mcap", lambda topic, m: channels.append((topic, m.channel)))
    first = next(channel for topic, channel in channels if topic == "scholar/journal")
    report = replay(Recording(rewritten(restarted, tmp_path / "x.mcap", change)), "scholar")
    (run,) = report.runs
    assert "it went on from snapshot " in run.words
    assert run.words.endswith("which the replay of that run has not given again")
    assert report.is_lossy
    assert not report.differs


@pytest.mark.parametrize(
    ("part", "payload", "words"),
    [
        ("scholar", Snapshot(state=b"short").SerializeToString(), "state must have 16 bytes; got 5"),
        ("scholar", b"\xff", "damaged|parsing"),
        ("echo", Snapshot().SerializeToString(), "no attribute 'load'"),
    ],
)
def test_what_is_no_snapshot_of_a_component_is_refused_by_name(restarted, part, payload, words):
    spec = load(restarted.with_name("small.toml")).component("scholar")
    hosted = Hosted(spec.__class__(**{**vars(spec), "run": f"tests.runtime.parts.{part}", "params": {}}), 1)
    with pytest.raises(ValueError, match=words):
        hosted.load(payload)
