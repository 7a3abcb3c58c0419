"""The doctor of recordings: a healthy one has nothing, and each fault is found by its kind."""

import struct

import pytest

from runtime.findings import Examination
from runtime.mcap_items import items
from runtime.mend import mend
from runtime.params import ConfigurationError
from runtime.recording import Recording
from tests.runtime.offline import rewritten, small_session, without


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    return small_session(tmp_path_factory.mktemp("small"))


def examined(file) -> dict[str, str]:
    """Kind -> words of its first finding."""
    found = {}
    for kind, words in Examination(Recording(file)).run():
        found.setdefault(kind, words)
    return found


def test_a_whole_session_is_healthy(session):
    assert examined(session) == {}


def changed(session, tmp_path, change) -> dict[str, str]:
    return examined(rewritten(session, tmp_path / "changed.mcap", change))


def test_a_lost_message_is_missed_in_its_sequence_and_by_whom_it_was_handed_to(session, tmp_path):
    found = changed(session, tmp_path, without("world/image", sequences=range(7, 9)))
    assert found["sequence"] == "world/image (run 0000000000000001): 2 lost"
    assert found["journal"].startswith("fickle was handed message 7 of world/image, which is missing")
    assert set(found) == {"sequence", "journal"}


def test_a_message_lost_at_the_end_is_missed_by_the_journal_alone(session, tmp_path):
    found = changed(session, tmp_path, without("world/image", sequences=range(39, 40)))
    assert found == {"journal": "fickle was handed message 39 of world/image, which is missing"}


@pytest.mark.parametrize("specs", [b"null", b"3", b'["a"]', b'[{"run": "x"}]'])
def test_a_launch_file_without_components_is_found(session, tmp_path, specs):
    launch = b'{"realm": "a", "components": ' + specs + b"}"
    file = rewritten(session, tmp_path / "odd.mcap", lambda _, message: message, attach=lambda _: launch)
    assert examined(file) == {"session": "the launch file holds no list of components with names"}


def test_messages_out_of_order_are_found(session, tmp_path):
    def back(topic, message):
        late = topic == "world/image" and message.sequence == 20
        return message._replace(log_ns=0, sequence=3) if late else message

    found = changed(session, tmp_path, back)
    assert found["order"] == "world/image: its log time is before that of the message in front of it"
    assert "lost" in found["sequence"] or "out of order" in found["sequence"]


def test_a_payload_that_is_no_message_is_found(session, tmp_path):
    def spoil(topic, message):
        spoilt = topic == "fickle/drive" and message.sequence == 5
        return message._replace(payload=b"\xff\xff\xff") if spoilt else message

    assert changed(session, tmp_path, spoil) == {"payload": "fickle/drive: a message can not be decoded"}


def test_a_missing_journal_is_named(session, tmp_path):
    found = changed(session, tmp_path, without("fickle/journal"))
    assert found == {"journal": "fickle has none: it can not be replayed"}


def test_a_missing_launch_file_is_found(session, tmp_path):
    file = rewritten(session, tmp_path / "no.mcap", lambda _, message: message, attach=lambda _: b"not JSON")
    assert examined(file)["session"] == "no launch file"


def data_end(file) -> int:
    """Where the data section ends."""
    with file.open("rb") as stream:
        for _ in items(stream, []):
            pass
        return stream.tell()


def chunk_offsets(content: bytes) -> list[int]:
    at, found = 8, []
    while at < len(content) - 8:
        code, length = struct.unpack_from("<BQ", content, at)
        found += [at] if code == 0x06 else []
        at += 9 + length
    return found


def test_a_torn_file_is_named_where_it_is_torn_and_mended_as_far_as_it_goes(session, tmp_path):
    torn = tmp_path / "torn.mcap"
    torn.write_bytes(session.read_bytes()[: data_end(session) - 100])
    before = list(Recording(torn).messages())
    assert "byte" in examined(torn)["file"]
    mended = mend(Recording(torn), tmp_path / "mended.mcap")
    assert mended.is_lossy
    assert mended.messages == len(before) > 40
    assert list(Recording(tmp_path / "mended.mcap").messages()) == before
    assert Recording(tmp_path / "mended.mcap").session() == Recording(torn).session()
    assert Recording(tmp_path / "mended.mcap").launch() == Recording(torn).launch()
    assert "file" not in examined(tmp_path / "mended.mcap")


def test_mending_passes_over_a_damaged_chunk_and_says_what_it_cost(tmp_path):
    session = small_session(tmp_path, ["world.frames=300"])
    content = bytearray(session.read_bytes())
    chunks = chunk_offsets(content)
    content[chunks[len(chunks) // 2] + 100] ^= 0xFF
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(content)
    mended = mend(Recording(damaged), tmp_path / "mended.mcap")
    assert len(mended.faults) == 1
    assert sum(mended.lost.values()) > 0
    assert mended.until_ns == max(m.time_ns for m in Recording(session).messages())


def test_mending_a_whole_file_loses_nothing(session, tmp_path):
    mended = mend(Recording(session), tmp_path / "mended.mcap")
    assert not mended.is_lossy
    assert list(Recording(tmp_path / "mended.mcap").messages()) == list(Recording(session).messages())


def test_mending_never_overwrites(session, tmp_path):
    before = session.read_bytes()
    with pytest.raises(ConfigurationError, match="must not exist yet"):
        mend(Recording(session), session)
    assert session.read_bytes() == before


def test_a_stranger_s_file_is_refused(tmp_path):
    file = tmp_path / "other.mcap"
    file.write_bytes(b"\x89MCAP0\r\n" * 2)
    with pytest.raises(ConfigurationError, match="must be a session of ours"):
        Examination(Recording(file)).run()
