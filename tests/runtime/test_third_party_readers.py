"""Other people's readers: a session explains itself to a reader that has never heard of our schemas.

The `mcap` command line and Foxglove read in the same way: the schemas embedded in the file, and nothing else. Each
file is read in a process of its own, in which our modules are not imported.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from runtime.recording import Recording

RECORDINGS = Path(__file__).parent.parent.parent / "recordings"
WHOLE = ("docking", "reverse", "lost")
READER = """
import json, sys
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
found = {}
with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream, decoder_factories=[DecoderFactory()])
    statistics = reader.get_summary().statistics
    times = []
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        rows = found.setdefault(channel.topic, [])
        values = [getattr(decoded, f.name) for f in decoded.DESCRIPTOR.fields]
        reals = [v for v in values if isinstance(v, float)]
        rows.append((message.sequence, message.publish_time, schema.name, type(decoded).__name__, sum(reals)))
        times.append(message.log_time)
    attachments = [a.name for a in reader.iter_attachments()]
    metadata = [m.name for m in reader.iter_metadata()]
assert not [name for name in sys.modules if name.split(".")[0] in ("runtime", "schemas", "components")]
json.dump([found, statistics.message_count, times == sorted(times), attachments, metadata], sys.stdout)
"""


@pytest.fixture(scope="module", params=WHOLE)
def both(request, tmp_path_factory):
    """A session as a stranger reads it, and as we do."""
    file = RECORDINGS / f"{request.param}.mcap"
    elsewhere = tmp_path_factory.mktemp("elsewhere")  # where none of our packages can be found
    words = [sys.executable, "-I", "-c", READER, str(file)]
    done = subprocess.run(words, cwd=elsewhere, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout), list(Recording(file).messages())


def test_every_message_is_decoded_from_the_embedded_schemas_alone(both):
    (found, _, _, _, _), ours = both
    wanted = {}
    for logged in ours:
        fields = type(message := logged.decoded()).DESCRIPTOR.fields
        reals = [value for field in fields if isinstance(value := getattr(message, field.name), float)]
        row = (logged.sequence, logged.capture_ns, logged.schema, logged.schema.rpartition(".")[2], sum(reals))
        wanted.setdefault(logged.topic, []).append(row)
    assert set(found) == set(wanted)
    for topic, rows in wanted.items():
        assert [tuple(row[:4]) for row in sorted(found[topic])] == [row[:4] for row in sorted(rows)]
        sums = zip(sorted(found[topic]), sorted(rows), strict=True)
        assert all(a[4] == b[4] or (math.isnan(a[4]) and math.isnan(b[4])) for a, b in sums)


def test_the_index_counts_every_message_and_gives_them_in_order_of_time(both):
    (_, count, in_order, _, _), ours = both
    assert count == len(ours)
    assert in_order


def test_the_launch_file_and_the_session_are_found_by_name(both):
    (_, _, _, attachments, metadata), _ = both
    assert attachments == ["launch.json"]
    assert metadata == ["berth.session"]
