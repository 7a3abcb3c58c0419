"""Other people's readers: a session explains itself to readers that have never heard of our schemas.

Each file is read by two of them that share no code, in a process of its own that can not import anything of ours.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from google.protobuf import descriptor_pool
from google.protobuf.descriptor_pb2 import FileDescriptorSet

from runtime.messages import descriptor_set, message_class
from runtime.recording import Recording
from tests.runtime import stranger

ROOT = Path(__file__).parent.parent.parent
FILE = ROOT / "recordings" / "reverse.mcap"
"""With images, policies and a snapshot."""


@pytest.fixture(scope="module")
def ours():
    """What we read."""
    return sorted(
        (row.topic, row.schema, row.sequence, row.capture_ns, stranger.digest(row.decoded()))
        for row in Recording(FILE).messages()
    )


@pytest.fixture(scope="module", params=["mcap", "pybag"])
def found(request, tmp_path_factory):
    """The session as a stranger reads it."""
    words = [sys.executable, "-I", stranger.__file__, request.param, str(FILE)]
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    done = subprocess.run(words, cwd=elsewhere, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_nothing_of_ours_was_imported(found):
    assert found["ours"] == []


def test_every_field_of_every_message_is_decoded_from_the_embedded_schemas_alone(found, ours):
    assert [tuple(row) for row in found["rows"]] == ours
    assert {"berth.Policy", "berth.Snapshot", "berth.Journal"} <= {row[1] for row in ours}


def test_every_image_opens_from_the_bytes_of_its_message(found):
    assert found["images"] == [[320, 240]]


def test_the_index_counts_every_message_and_gives_them_in_order_of_time(found, ours):
    assert found["count"] == len(ours)
    assert found["in_order"]


def test_the_launch_file_and_the_session_are_found_by_name(found):
    assert found["attachments"] == ["launch.json"]
    assert found["metadata"] == ["berth.session"]


def full_names():
    """Every message that can be on the bus."""
    message_class("berth.Percept")  # imports them all
    pool = descriptor_pool.Default()
    for file in sorted(ROOT.glob("schemas/*.proto")):
        descriptor = pool.FindFileByName(f"schemas/{file.name}")
        yield from (message.full_name for message in descriptor.message_types_by_name.values())


@pytest.mark.parametrize("name", list(full_names()))
def test_a_schema_holds_all_that_it_imports_each_file_after_its_imports(name):
    files = FileDescriptorSet.FromString(descriptor_set(name)).file
    known = set()
    for file in files:
        assert set(file.dependency) <= known
        assert file.name not in known
        known.add(file.name)
    assert stranger._class_of(name, descriptor_set(name)).DESCRIPTOR.full_name == name
