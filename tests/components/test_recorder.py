"""The recorder: everything on the bus, what is missing by name, and a file that explains itself."""

import json
from pathlib import Path

import pytest
from google.protobuf import descriptor_pool, message_factory
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.unknown_fields import UnknownFieldSet
from mcap.reader import make_reader

from components.recorder.component import Recorder
from components.recorder.gaps import Gaps
from components.recorder.ports import Params
from runtime.launch import load
from runtime.params import ConfigurationError, build
from runtime.recording import Recording
from schemas.drive_pb2 import BaseCommand
from schemas.image_pb2 import CompressedImage
from tests.recorded_session import LAUNCH, record

COMMAND, IMAGE = BaseCommand.DESCRIPTOR.full_name, CompressedImage.DESCRIPTOR.full_name


@pytest.fixture
def file(tmp_path) -> Path:
    return tmp_path / "session.mcap"


@pytest.fixture
def recorder(file) -> Recorder:
    return Recorder(Params(file=str(file)), load(LAUNCH, recording=file), "then")


def command(recorder: Recorder, sequence: int, run: int = 7, v_mps: float = 0.1):
    payload = BaseCommand(v_mps=v_mps).SerializeToString()
    return recorder.message("base/actuate", COMMAND, payload, run, sequence, 5 * sequence, 5 * sequence + 1)


def image(recorder: Recorder, sequence: int):
    return recorder.message("camera/image", IMAGE, b"", 9, sequence, 5 * sequence, 5 * sequence + 1)


def test_every_message_is_in_the_file_as_it_came(recorder, file):
    for sequence in range(5):
        assert command(recorder, sequence) == ()
    recorder.close()
    found = list(Recording(file).messages())
    assert [(m.topic, m.schema, m.run, m.sequence, m.capture_ns, m.time_ns) for m in found] == [
        ("base/actuate", COMMAND, 7, k, 5 * k, 5 * k + 1) for k in range(5)
    ]
    assert {m.decoded().v_mps for m in found} == {0.1}


def test_a_hole_in_a_sequence_is_said_at_once_by_name_and_counted(recorder):
    command(recorder, 0)
    (output,) = command(recorder, 4)
    gap = output.message
    assert output.port == "gap"
    assert (gap.key, gap.run, gap.first_missing, gap.count) == ("base/actuate", 7, 1, 3)
    (output,) = image(recorder, 0)
    assert (output.port, output.message.lost, output.message.messages) == ("ack", 3, 3)
    assert command(recorder, 5) == ()


def test_each_run_of_a_key_has_its_own_sequence(recorder):
    assert command(recorder, 9, run=1) == (), "it may have begun before us"
    assert command(recorder, 0, run=2) == (), "a restart begins anew"
    assert command(recorder, 10, run=1) == ()
    assert command(recorder, 2, run=2)[0].message.count == 1


def test_a_message_out_of_order_is_no_loss():
    gaps = Gaps()
    assert [gaps.missing("a/b", 1, sequence) for sequence in (0, 1, 3, 2, 3, 4)] == [0, 0, 1, 0, 0, 0]
    assert gaps.lost == 1


def test_each_camera_frame_is_acknowledged_with_its_capture_time(recorder):
    (output,) = image(recorder, 3)
    assert (output.port, output.capture_ns, output.message.messages) == ("ack", 15, 1)
    assert command(recorder, 0) == ()


def test_what_was_recorded_before_a_flush_survives_a_kill(recorder, file, tmp_path):
    command(recorder, 0)
    for _ in range(10):  # ten ticks are a second of wall time
        recorder.tick(0)
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(file.read_bytes())
    assert [m.sequence for m in Recording(torn).messages()] == [0]
    assert not Recording(torn).whole()
    recorder.close()
    assert Recording(file).whole()


def test_a_flush_comes_at_least_once_a_second():
    with pytest.raises(ConfigurationError, match=r"params\.flush_s must be between 0\.01 and 1"):
        build(Params, {"flush_s": 1.5}, "params")


def test_closing_says_the_last_count_and_twice_is_once(recorder, file):
    command(recorder, 0)
    (output,) = recorder.close()
    assert (output.port, output.message.messages, output.message.lost) == ("ack", 1, 0)
    recorder.close()
    assert Recording(file).whole()


def test_an_existing_file_is_refused_and_left_alone(file):
    file.write_bytes(b"precious")
    with pytest.raises(ConfigurationError, match=r"session\.mcap: must not exist yet"):
        Recorder(Params(file=str(file)), load(LAUNCH, recording=file), "")
    assert file.read_bytes() == b"precious"


@pytest.fixture(scope="module")
def session(tmp_path_factory) -> Path:
    """Three seconds of the whole system."""
    file = tmp_path_factory.mktemp("recorder") / "session.mcap"
    record(file, started="2005-09-07T12:00:00Z", duration_s=3.0)
    return file


def test_a_session_explains_itself_without_this_program(session):
    """Every message decodes from the schemas in the file alone, with a foreign reader and a pool of its own."""
    pools: dict[int, type] = {}
    topics = set()
    with session.open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            assert (schema.encoding, channel.message_encoding) == ("protobuf", "protobuf")
            if schema.id not in pools:
                pools[schema.id] = class_from(schema.data, schema.name)
            decoded = pools[schema.id].FromString(message.data)
            assert decoded.SerializeToString(deterministic=True) == message.data
            assert len(UnknownFieldSet(decoded)) == 0
            topics.add(channel.topic)
    wired = {key for spec in load(LAUNCH).components for key in spec.inputs.values()} - {"grasper/grasp"}
    assert wired - topics <= {"learner/policy", "recorder/ack"}, "three seconds teach nothing yet"


def class_from(data: bytes, name: str) -> type:
    pool = descriptor_pool.DescriptorPool()
    for file in FileDescriptorSet.FromString(data).file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def test_a_session_holds_its_launch_file_seed_versions_and_machine(session):
    with session.open("rb") as stream:
        reader = make_reader(stream)
        (metadata,) = [record for record in reader.iter_metadata() if record.name == "berth.session"]
        (attachment,) = list(reader.iter_attachments())
    said = metadata.metadata
    assert (said["realm"], said["clock"], said["seed"]) == ("berth/sim", "lockstep", "1")
    assert said["started"] == "2005-09-07T12:00:00Z"
    assert {"python", "processor", "numpy", "protobuf"} <= set(json.loads(said["fingerprint"]))
    launch = json.loads(attachment.data)
    pilot = next(spec for spec in launch["components"] if spec["name"] == "pilot")
    assert pilot["params"]["train_s"] == 2400.0, "every parameter with its value, given or not"
    assert isinstance(pilot["seed"], int)
    assert pilot["inputs"]["percept"] == "tracker/percept"


def test_the_camera_image_is_one_that_any_viewer_shows(session):
    (first, *_) = Recording(session).messages({"camera/image"})
    assert first.schema == "foxglove.CompressedImage"
    image = first.decoded()
    assert image.format == "jpeg"
    assert image.data[:3] == b"\xff\xd8\xff"
    assert image.timestamp.ToNanoseconds() == first.capture_ns
