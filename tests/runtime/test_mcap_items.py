"""The reader of hostile files: nothing is believed, nothing is raised, the undamaged rest is read."""

import random
import struct
import tracemalloc
import zlib
from io import BytesIO

import lz4.frame
import pytest
import zstandard
from mcap.reader import make_reader

from benchmarks.mutations import mutated
from runtime.mcap_items import LARGEST_BYTES, MAGIC, End, RawMessage, items
from runtime.params import ConfigurationError
from runtime.recording import Recording
from tests.runtime.offline import small_session

CHUNK, MESSAGE = 0x06, 0x05


@pytest.fixture(scope="module")
def content(tmp_path_factory):
    return small_session(tmp_path_factory.mktemp("small")).read_bytes()


def read(content: bytes):
    faults = []
    found = list(items(BytesIO(content), faults))
    return found, faults


def record(code: int, content: bytes, length: int | None = None) -> bytes:
    return struct.pack("<BQ", code, len(content) if length is None else length) + content


def chunk(data: bytes, *, compression=b"", packed: bytes | None = None, size=None, crc=None) -> bytes:
    packed = data if packed is None else packed
    head = struct.pack("<QQQI", 0, 0, len(data) if size is None else size, zlib.crc32(data) if crc is None else crc)
    return record(
        CHUNK, head + struct.pack("<I", len(compression)) + compression + struct.pack("<Q", len(packed)) + packed
    )


def message(payload: bytes) -> bytes:
    return record(MESSAGE, struct.pack("<HIQQ", 7, 1, 2, 3) + payload)


def test_every_message_that_the_mcap_library_reads_is_read(content):
    found, faults = read(content)
    ours = [tuple(m) for m in found if isinstance(m, RawMessage)]
    theirs = [
        (m.channel_id, m.sequence, m.log_time, m.publish_time, m.data)
        for _, _, m in make_reader(BytesIO(content)).iter_messages(log_time_order=False)
    ]
    assert ours == theirs
    assert len(ours) > 80
    assert faults == []
    assert isinstance(found[-1], End)


@pytest.mark.parametrize(
    ("broken", "words"),
    [
        (chunk(b"x" * 40), "a record in a chunk claims"),
        (chunk(b"x" * 5), "a chunk ends within a record"),
        (chunk(message(b"a"), crc=1), "checksum"),
        (chunk(message(b"a"), size=7), "unpacks to"),
        (chunk(b"", size=LARGEST_BYTES + 1), "at most"),
        (chunk(b"a", compression=b"lz4", packed=b"\0" * 9), "can not be unpacked"),
        (chunk(b"a", compression=b"zstd", packed=b"\0" * 9), "can not be unpacked"),
        (chunk(b"a", compression=b"brotli"), "can not be unpacked"),
        (record(CHUNK, b"short"), "can not be read"),
        (record(MESSAGE, b"short"), "has no head"),
        (record(0x04, struct.pack("<HHI", 1, 1, 0xFFFFFFFF)), "can not be read"),
    ],
)
def test_a_damaged_record_is_named_and_the_next_one_read(broken, words):
    found, faults = read(MAGIC + broken + chunk(message(b"whole")) + record(0x0F, b"\0\0\0\0"))
    assert [m.payload for m in found if isinstance(m, RawMessage)] == [b"whole"]
    assert len(faults) == 1
    assert words in faults[0].words
    assert faults[0].offset == len(MAGIC)


@pytest.mark.parametrize("length", [LARGEST_BYTES + 1, 2**40, 2**64 - 1])
def test_a_length_beyond_belief_ends_the_reading(length):
    found, faults = read(MAGIC + chunk(message(b"first")) + record(MESSAGE, b"", length))
    assert [m.payload for m in found] == [b"first"]
    assert f"claims {length} bytes" in faults[0].words


@pytest.mark.parametrize("compression", [b"lz4", b"zstd"])
@pytest.mark.parametrize("claimed", [100, LARGEST_BYTES, 2**50])
def test_a_bomb_is_not_unpacked(compression, claimed):
    zeros = bytes(256 * 1024 * 1024)
    packed = lz4.frame.compress(zeros) if compression == b"lz4" else zstandard.compress(zeros)
    del zeros
    tracemalloc.start()
    found, faults = read(MAGIC + chunk(b"", compression=compression, packed=packed, size=claimed))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found == []
    assert len(faults) == 2  # the chunk, and the end
    assert peak < 3 * LARGEST_BYTES


def test_any_prefix_gives_a_prefix_of_the_messages(content):
    whole = [m for m in read(content)[0] if isinstance(m, RawMessage)]
    counts = set()
    for cut in range(len(MAGIC), len(content), 97):
        found, _ = read(content[:cut])
        messages = [m for m in found if isinstance(m, RawMessage)]
        assert messages == whole[: len(messages)]
        counts.add(len(messages))
    assert len(counts) > 5


def test_no_mutation_raises(content, tmp_path):
    """A few hundred; `make bench` tries ten thousand."""
    rng, file = random.Random(7), tmp_path / "mutant.mcap"
    for _ in range(300):
        file.write_bytes(mutated(content, rng))
        try:
            recording = Recording(file)
        except ConfigurationError:
            continue
        recording.session()
        recording.launch()
        for logged in recording.messages():
            logged.decoded()
