"""Every component of the simulation, replayed; and a live session of real processes."""

import os
import signal

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from runtime.launch import load
from runtime.recording import Recording
from runtime.replay import replay
from runtime.supervise import Supervisor
from tests.recorded_session import LAUNCH
from tests.runtime.offline import rewritten, without
from tests.runtime.system import recorded_system, run_to_end, run_until

FOLDS = [spec.name for spec in load(LAUNCH).components if not spec.tap]


@pytest.mark.xdist_group("session")
@pytest.mark.parametrize("name", FOLDS)
def test_every_output_of_a_session_is_said_again_to_the_byte(twins, name):
    report = replay(Recording(twins.first), name)
    assert not report.differs, report.first[0]
    assert not report.is_lossy
    assert report.count("identical") == sum(report.outputs.values()) > 0


@pytest.mark.xdist_group("session")
@pytest.mark.parametrize("name", ["tracker", "pilot", "learner"])
def test_a_component_is_told_nothing_of_what_it_said(twins, tmp_path, name):
    keys = load(LAUNCH).component(name).outputs.values()
    stripped = rewritten(twins.first, tmp_path / "stripped.mcap", without(*keys, "camera/image"))
    said = []
    replay(Recording(stripped), name, tell=lambda sample, _: said.append((sample.key, sample.sequence, sample.payload)))
    recorded = {(m.topic, m.sequence, m.payload) for m in Recording(twins.first).messages(keys)}
    assert len(said) == len(recorded) > 0
    assert set(said) == recorded


def processes(directory, clock: str, frames: int):
    """A world and a component that sums, each a process, recorded."""
    words = [f"world.frames={frames}", "world.window=16"]
    return recorded_system(directory, words, fold="fickle", echo='restart = "on-failure"', clock=clock)


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    """Real processes at real time beside busy ones; one of them is killed and started again."""
    system = processes(tmp_path_factory.mktemp("live"), "real", 0)
    with Supervisor(system) as supervisor:
        run_until(supervisor, lambda: _published(supervisor, "fickle") >= 8)
        os.kill(supervisor.pids["fickle"], signal.SIGKILL)
        run_until(supervisor, lambda: bool(supervisor.deaths) and not supervisor.missing)
        run_until(supervisor, lambda: 8 <= _published(supervisor, "fickle") < _published(supervisor, "world") - 8)
    return system.recording


def _published(supervisor, name) -> int:
    status = supervisor.statuses.get(name)
    return 0 if status is None else status.published


def test_a_live_world_is_replayed_to_the_byte(live):
    report = replay(Recording(live), "world")
    assert (report.differs, report.is_lossy) == (False, False)
    assert report.count("identical") > 16


def test_a_killed_component_is_replayed_up_to_its_end_and_again_from_its_start(live):
    report = replay(Recording(live), "fickle")
    assert not report.differs, report.first[0]
    assert len(report.runs) == 2
    assert "without a stop" in report.runs[0].words
    assert report.runs[1].words == ""
    assert all(comparison.identical > 0 for comparison in report.comparisons)
    assert "started again" in report.notes[0]


def sorted_by_log_time(source, target):
    """As any tool rewrites a file that sorts it."""
    with source.open("rb") as stream, target.open("wb") as out:
        reader, writer = make_reader(stream), Writer(out)
        writer.start()
        for metadata in reader.iter_metadata():
            writer.add_metadata(metadata.name, metadata.metadata)
        for attachment in reader.iter_attachments():
            writer.add_attachment(0, 0, attachment.name, attachment.media_type, attachment.data)
        channels = {}
        for schema, channel, message in reader.iter_messages():
            if channel.id not in channels:
                known = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, "protobuf", known, channel.metadata)
            writer.add_message(
                channels[channel.id], message.log_time, message.data, message.publish_time, message.sequence
            )
        writer.finish()
    return target


def test_a_lockstep_session_that_a_tool_has_sorted_by_log_time_is_replayed_all_the_same(tmp_path):
    system = processes(tmp_path, "lockstep", 300)
    with Supervisor(system) as supervisor:
        run_to_end(supervisor)
    again = Recording(sorted_by_log_time(system.recording, tmp_path / "sorted.mcap"))
    times = [logged.time_ns for logged in again.messages()]
    assert times == sorted(times) != []
    shown = list(again.messages(["world/image"]))
    assert [logged.time_ns for logged in shown] == [logged.capture_ns for logged in shown]
    for name in ("world", "fickle"):
        report = replay(again, name)
        assert (report.differs, report.is_lossy, report.notes) == (False, False, [])
        assert report.count("identical") >= 300
