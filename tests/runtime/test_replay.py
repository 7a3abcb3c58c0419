"""A component once more, in its journal's order: what is the same, what differs, how far it goes."""

from pathlib import Path

import pytest

from runtime.contract import STOP, Event
from runtime.journal import JournalWriter
from runtime.launch import load
from runtime.log import LogWriter
from runtime.params import ConfigurationError
from runtime.recording import Logged, Recording
from runtime.replay import Report, replay
from schemas.drive_pb2 import BaseCommand
from schemas.session_pb2 import Journal
from tests.runtime.offline import FRAMES, rewritten, small_session, without
from tests.runtime.parts.fickle.component import Fickle
from tests.runtime.parts.fickle.ports import Params


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    return small_session(tmp_path_factory.mktemp("small"))


def again(file, *overrides: str, name: str = "fickle", **options) -> Report:
    return replay(Recording(file), name, overrides, **options)


@pytest.mark.parametrize("name", ["fickle", "world"])
def test_every_output_of_an_honest_component_is_the_same(session, name):
    report = again(session, name=name)
    assert report.count("identical") == FRAMES + (name == "world")  # the world says goodbye
    assert not report.differs
    assert not report.is_lossy
    assert not report.notes


@pytest.mark.parametrize("fault", ["clock", "random", "hidden"])
def test_the_check_fails_for_a_component_that_knows_more_than_its_journal(tmp_path, fault):
    report = again(small_session(tmp_path, [f"fickle.fault={fault}"]))
    assert report.differs
    assert report.first[0].key == "fickle/drive"
    assert {difference.field for difference in report.first[0].fields} == {"omega_radps"}


def test_hidden_state_is_told_from_a_run_of_its_own(tmp_path):
    Fickle.answered = 0
    file = small_session(tmp_path, ["fickle.fault=hidden"])
    Fickle.answered = 0
    assert not again(file).differs
    assert again(file).differs


def test_recorded_outputs_are_never_read_as_state(session, tmp_path):
    told = []
    stripped = rewritten(session, tmp_path / "stripped.mcap", without("fickle/drive"))
    report = again(stripped, tell=lambda sample, _: told.append((sample.sequence, sample.capture_ns, sample.payload)))
    recorded = [(m.sequence, m.capture_ns, m.payload) for m in Recording(session).messages(["fickle/drive"])]
    assert told == recorded
    assert not any(comparison.has_record for comparison in report.comparisons)


def test_another_parameter_shows_what_it_changes_field_by_field(session):
    report = again(session, "fickle.gain=2.0")
    assert report.count("different") == FRAMES - 1  # 2 * 0 is 0
    first = report.first[0]
    assert (first.time_ns, first.key, first.sequence) == (125_000_000, "fickle/drive", 1)
    assert str(first) == "0.125 s fickle/drive 1: v_mps: recorded 0.125, replayed 0.25"


def test_a_changed_output_is_found_with_its_time_and_sequence(session, tmp_path):
    def lie(topic, message):
        if topic == "fickle/drive" and message.sequence == 17:
            return message._replace(payload=BaseCommand(v_mps=9.0).SerializeToString())
        return message

    report = again(rewritten(session, tmp_path / "lie.mcap", lie))
    assert report.count("different") == 1
    assert report.count("identical") == FRAMES - 1
    assert str(report.first[0]).startswith("2.125 s fickle/drive 17: v_mps: recorded 9.0, replayed ")


def test_another_capture_time_is_a_difference(session, tmp_path):
    def late(topic, message):
        return message._replace(publish_ns=message.publish_ns + 1) if topic == "fickle/drive" else message

    report = again(rewritten(session, tmp_path / "late.mcap", late))
    assert report.count("different") == FRAMES
    assert report.first[0].fields[0].field == "capture time"


def test_a_missing_input_is_named_and_everything_before_it_compared(session, tmp_path):
    report = again(rewritten(session, tmp_path / "hole.mcap", without("world/image", sequences=range(12, 13))))
    assert [run.words for run in report.runs] == ["replayable until 1.500 s: message 12 of world/image is missing"]
    assert report.count("identical") == 12
    assert not report.differs
    assert report.is_lossy
    assert report.count("beyond") == FRAMES - 12


def test_a_missing_last_input_is_named_too(session, tmp_path):
    report = again(rewritten(session, tmp_path / "end.mcap", without("world/image", sequences=range(39, 40))))
    assert [run.words for run in report.runs] == ["replayable until 4.875 s: message 39 of world/image is missing"]
    assert report.count("identical") == FRAMES - 1


def test_a_death_is_handed_over_with_its_name(session, tmp_path):
    said = []

    def add(batch):
        batch.ports.append("gone:somebody")
        for column, value in ((batch.port, len(batch.ports) - 1), (batch.source_run, 7), (batch.source_sequence, 0)):
            column.insert(0, value)
        batch.time_delta_ns.insert(0, 0)
        return batch

    def change(topic, message):
        if topic != "fickle/journal":
            return message
        return message._replace(payload=add(Journal.FromString(message.payload)).SerializeToString())

    again(rewritten(session, tmp_path / "gone.mcap", change), tell=lambda sample, _: said.append(sample))
    assert BaseCommand.FromString(said[0].payload).v_mps == len("somebody")


def test_a_lost_last_output_is_a_difference(session, tmp_path):
    """The recorder hears everybody out; what comes after all it has is something new."""
    report = again(rewritten(session, tmp_path / "last.mcap", without("fickle/drive", sequences=range(39, 40))))
    assert report.count("different") == 1
    assert str(report.first[0]) == "4.875 s fickle/drive 39: message: recorded none, replayed one"


def test_outputs_are_paired_by_their_sequence(session, tmp_path):
    def shift(topic, message):
        return message._replace(sequence=message.sequence + 1) if topic == "fickle/drive" else message

    report = again(rewritten(session, tmp_path / "more.mcap", shift))
    assert report.count("different") == FRAMES
    assert report.count("unpaired") == 1
    assert report.comparisons[0].changed == {"fickle/drive": FRAMES}


def test_a_lost_output_is_no_difference(session, tmp_path):
    report = again(rewritten(session, tmp_path / "hole.mcap", without("fickle/drive", sequences=range(5, 8))))
    assert not report.differs
    assert report.count("unpaired") == 3
    assert report.is_lossy


def rebatched(session, tmp_path, edit) -> Report:
    """Replay with the journal of `fickle` edited as a list of entries."""

    def change(topic, message):
        if topic != "fickle/journal":
            return message
        batch = edit(Journal.FromString(message.payload))
        return None if batch is None else message._replace(payload=batch.SerializeToString())

    return again(rewritten(session, tmp_path / "journal.mcap", change))


def test_a_hole_in_the_journal_is_named(session, tmp_path):
    def skip(batch):
        batch.first += 3
        return batch

    report = rebatched(session, tmp_path, skip)
    assert "events 0 to 2 of the journal of fickle are missing" in report.runs[0].words


def test_a_journal_without_stop_ends_where_it_ends(session, tmp_path):
    def cut(batch):
        for column in (batch.port, batch.source_run, batch.source_sequence, batch.time_delta_ns):
            del column[10:]
        return batch

    report = rebatched(session, tmp_path, cut)
    assert report.runs[0].words == "the journal ends at 1.125 s, without a stop"
    assert report.count("identical") == 10
    assert report.count("beyond") == FRAMES - 10
    assert not report.differs


def test_an_event_that_the_component_has_no_input_for_is_named(session, tmp_path):
    def rename(batch):
        batch.ports[batch.port[4]] = "loaded snapshot 7"
        return batch

    assert "fickle has no input 'loaded snapshot 7'" in rebatched(session, tmp_path, rename).runs[0].words


def test_an_input_that_the_launch_file_does_not_wire_is_named(session, tmp_path):
    def unwire(text):
        return text.replace(b'"image": "world/image"', b'"gone": "world/image"')

    file = rewritten(session, tmp_path / "unwired.mcap", lambda _, message: message, attach=unwire)
    report = again(file)
    assert report.runs[0].words == "replayable until 0.000 s: the launch file wires nothing to fickle.image"
    assert not report.differs
    assert report.is_lossy


def test_without_a_journal_nothing_can_be_replayed(session, tmp_path):
    file = rewritten(session, tmp_path / "bare.mcap", without("fickle/journal"))
    with pytest.raises(ConfigurationError, match="holds no journal of fickle"):
        again(file)


def test_a_restarted_component_is_replayed_run_by_run_from_a_cold_start(session, tmp_path):
    """Run 2 is killed after 20 frames; run 9 answers the others."""
    messages = list(Recording(session).messages())
    frames = [m for m in messages if m.topic == "world/image"]
    first = [m for m in messages if m.topic == "fickle/drive" and m.sequence < 20]
    fresh, second = Fickle(Params(), 0), []
    for number, frame in enumerate(frames[20:]):
        (output,) = fresh.handle(Event(frame.time_ns, "image", None, frame.capture_ns))
        payload = output.message.SerializeToString(deterministic=True)
        second.append(first[0]._replace(run=9, sequence=number, payload=payload, capture_ns=frame.capture_ns))
    journals = [journal_of(2, frames[:20]), journal_of(9, frames[20:], stop=True)]
    parts = [*frames[:20], *first, journals[0], *frames[20:], *second, journals[1]]
    report = again(logged(tmp_path / "restarted.mcap", session.with_suffix(".toml"), parts))
    assert [outcome.events for outcome in report.runs] == [20, FRAMES - 20 + 1]
    assert (report.count("identical"), report.differs) == (FRAMES, False)
    assert report.runs[0].words == "the journal ends at 2.375 s, without a stop"
    (note,) = report.notes
    assert note == "fickle was started again: run 0000000000000009 is replayed as from a cold start"


def journal_of(run, frames, *, stop=False) -> Logged:
    writer = JournalWriter()
    for frame in frames:
        writer.add("image", frame.run, frame.sequence, frame.time_ns, 0)
    if stop:
        writer.add(STOP, 0, 0, frames[-1].time_ns, 0)
    payload = writer.take().SerializeToString()
    return Logged("fickle/journal", "berth.Journal", payload, run, 0, frames[-1].time_ns, frames[-1].time_ns)


def logged(file, launch, messages) -> Path:
    log = LogWriter(file, load(launch), started="now")
    for m in messages:
        log.write(m.topic, m.schema, m.payload, m.run, m.sequence, m.capture_ns, m.time_ns)
    log.close()
    return file


def test_a_torn_file_is_replayed_up_to_there(tmp_path):
    whole = small_session(tmp_path, ["world.frames=600"])
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(whole.read_bytes()[: whole.stat().st_size * 7 // 10])
    report = again(torn)
    assert report.runs[0].words == "the journal ends at 31.875 s, without a stop"
    assert report.count("identical") == 256  # a batch of the journal
    assert report.is_lossy
    assert not report.differs
    assert "of its" in report.notes[-1]


def test_a_component_that_raises_now_is_a_finding(session):
    report = again(session, "fickle.fault=raises")
    assert report.differs
    assert report.runs[0].raised == "RuntimeError at 2.125 s on image: told to raise"


def test_on_another_machine_real_numbers_may_differ_a_little(session, tmp_path):
    def nearly(topic, message):
        if topic != "fickle/drive":
            return message
        drive = BaseCommand.FromString(message.payload)
        drive.v_mps *= 1.0 + 1e-9
        return message._replace(payload=drive.SerializeToString())

    file = rewritten(session, tmp_path / "nearly.mcap", nearly)
    assert again(file).count("different") == FRAMES - 1
    assert _as_if_elsewhere(file, tmp_path).count("identical") == FRAMES


def _as_if_elsewhere(file, tmp_path) -> Report:
    """Replay a copy whose fingerprint is another one."""
    elsewhere = tmp_path / "elsewhere.mcap"
    elsewhere.write_bytes(file.read_bytes().replace(b'"python"', b'"pYthon"', 1))
    report = again(elsewhere)
    assert report.other_machine
    return report


@pytest.mark.parametrize(
    ("name", "overrides", "words"),
    [
        ("nobody", (), "component nobody is unknown; known are world, fickle, recorder"),
        ("recorder", (), "component recorder must be no tap"),
        ("fickle", ("fickle.speed=1",), "fickle.params.speed is unknown"),
        ("fickle", ("world.frames=1",), "--set world.frames=1: must begin with fickle, task or session"),
        ("fickle", ("fickle.fault=none",), "fickle.params.fault must be one of"),
    ],
)
def test_what_can_not_be_replayed_is_said_in_one_line(session, name, overrides, words):
    with pytest.raises(ConfigurationError) as refusal:
        again(session, *overrides, name=name)
    assert words in str(refusal.value)
    assert "\n" not in str(refusal.value)
