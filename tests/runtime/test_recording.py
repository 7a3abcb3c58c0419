"""A session's file: what was written is read, also from a torn, damaged or foreign one."""

import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import Writer

from runtime.log import LogWriter
from runtime.messages import message_class
from runtime.params import ConfigurationError
from runtime.recording import Logged, Recording
from schemas.drive_pb2 import BaseCommand
from tests.runtime.system import small_system

COMMAND = "berth.BaseCommand"


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    return small_system(tmp_path_factory.mktemp("system"))


def rows(count: int, size: int = 40) -> list[Logged]:
    """Commands and images of one publisher each."""
    found = []
    for k in range(count):
        payload = BaseCommand(v_mps=k + 0.5).SerializeToString()
        found.append(Logged("base/actuate", COMMAND, payload, 7, k, k * 10, k * 10 + 1))
        found.append(
            Logged("camera/image", "foxglove.CompressedImage", bytes([k % 251]) * size, 2**63, k, k * 10, k * 10 + 2)
        )
    return found


def write(file, system, messages, **options) -> Recording:
    log = LogWriter(file, system, started="then", **options)
    for message in messages:
        log.write(*message)
    log.close()
    return Recording(file)


@pytest.mark.parametrize("version", ["2", "10", "0", "-1", "1.0", "", "\u0661", "x" * 5000])
def test_another_format_than_this_release_reads_is_refused_by_name(tmp_path, system, monkeypatch, version):
    monkeypatch.setattr("runtime.log.FORMAT", version)
    with pytest.raises(ConfigurationError) as refusal:
        write(tmp_path / "new.mcap", system, rows(3))
    assert str(refusal.value).startswith(f"{tmp_path}/new.mcap: session format must be one that this release reads, up")
    assert f"got {version[:40]!r}" in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_a_session_says_its_format_and_one_that_does_not_is_of_the_first(tmp_path, system, monkeypatch):
    assert write(tmp_path / "a.mcap", system, rows(3)).session()["format"] == "1"
    monkeypatch.setattr("runtime.recording.SESSION", "nobody's")
    assert Recording(tmp_path / "a.mcap").session() == {}


@pytest.mark.parametrize("compression", ["lz4", "zstd", "none"])
def test_what_was_written_is_read_in_its_order(tmp_path, system, compression):
    recording = write(tmp_path / "a.mcap", system, rows(500), compression=compression, chunk_bytes=4096)
    assert list(recording.messages()) == rows(500)
    assert recording.whole()
    assert recording.session()["started"] == "then"
    assert recording.launch()["realm"] == system.realm


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["a/b", "c/d", "e/f"]),
            st.binary(max_size=200),
            st.integers(1, 2**64 - 1),
            st.integers(0, 2**32 - 1),
            st.integers(0, 2**62),
            st.integers(0, 2**62),
        ),
        max_size=30,
    )
)
def test_any_message_survives_the_file(tmp_path_factory, system, values):
    messages = [Logged(topic, COMMAND, *rest) for topic, *rest in values]
    file = tmp_path_factory.mktemp("any") / "any.mcap"
    assert list(write(file, system, messages, chunk_bytes=64).messages()) == messages


def test_only_the_topics_asked_for_are_read(tmp_path, system):
    recording = write(tmp_path / "a.mcap", system, rows(50))
    assert list(recording.messages({"base/actuate"})) == rows(50)[::2]
    assert list(recording.messages({"nobody/knows"})) == []


def test_topics_count_messages_bytes_and_holes(tmp_path, system):
    messages = [m for m in rows(50) if not (m.topic == "base/actuate" and m.sequence in {10, 11, 30})]
    topics = {topic.topic: topic for topic in write(tmp_path / "a.mcap", system, messages).topics()}
    command, image = topics["base/actuate"], topics["camera/image"]
    assert (command.count, command.lost, command.run, command.schema) == (47, 3, 7, COMMAND)
    assert (image.count, image.lost, image.bytes) == (50, 0, 50 * 40)


def test_a_torn_file_is_read_up_to_the_tear(tmp_path, system):
    whole = tmp_path / "whole.mcap"
    write(whole, system, rows(300), chunk_bytes=1024)
    data, expected = whole.read_bytes(), rows(300)
    counts = []
    for share in range(1, 30):
        torn = tmp_path / "torn.mcap"
        torn.write_bytes(data[: len(data) * share // 30])
        recording = Recording(torn)
        found = list(recording.messages())
        assert not recording.whole()
        assert found == expected[: len(found)]
        counts.append(len(found))
    assert counts == sorted(counts)
    assert counts[-1] > 500
    assert Recording(whole).whole()


def test_all_before_a_flush_survives_a_kill(tmp_path, system):
    file, killed = tmp_path / "a.mcap", tmp_path / "killed.mcap"
    log = LogWriter(file, system, started="")
    for message in rows(20):
        log.write(*message)
    log.flush()
    killed.write_bytes(file.read_bytes())
    log.close()
    assert list(Recording(killed).messages()) == rows(20)
    assert Recording(killed).launch()["realm"] == system.realm


def test_an_existing_file_is_refused_and_left_alone(tmp_path, system):
    file = tmp_path / "a.mcap"
    file.write_bytes(b"precious")
    with pytest.raises(ConfigurationError, match=r"a\.mcap: must not exist yet; a recording is never overwritten"):
        LogWriter(file, system, started="")
    assert file.read_bytes() == b"precious"


def test_closing_twice_is_closing_once(tmp_path, system):
    log = LogWriter(tmp_path / "a.mcap", system, started="")
    log.close()
    log.close()
    assert Recording(tmp_path / "a.mcap").whole()


def test_a_foreign_mcap_has_messages_but_no_session(tmp_path):
    with (tmp_path / "foreign.mcap").open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        channel = writer.register_channel("/chatter", "json", 0, {"run": "no number"})
        writer.add_message(channel, 1, b"{}", 2)
        writer.finish()
    recording = Recording(tmp_path / "foreign.mcap")
    assert (recording.session(), recording.launch()) == ({}, {})
    (message,) = recording.messages()
    assert (message.topic, message.payload, message.run) == ("/chatter", b"{}", 0)
    assert message.decoded() is None


def test_damaged_payloads_and_unknown_schemas_decode_to_none():
    assert Logged("a/b", COMMAND, b"\xff\xff", 1, 0, 0, 0).decoded() is None
    assert Logged("a/b", "nobody.Knows", b"", 1, 0, 0, 0).decoded() is None
    assert message_class("nobody.Knows") is None


@pytest.mark.parametrize("content", [b"", b"\x89MCAP", b"\x89MCAP1\r\n", b"not at all MCAP"])
def test_what_is_not_mcap_is_refused_at_once(tmp_path, content):
    (tmp_path / "x.mcap").write_bytes(content)
    with pytest.raises(ConfigurationError, match=r"x\.mcap: must be "):
        Recording(tmp_path / "x.mcap")


def damaged(data: bytes, number: int) -> bytes:
    """A few bytes changed, a piece cut out or doubled, or the end missing: from a seed."""
    chance = np.random.default_rng([2005, number])
    found = bytearray(data)
    kind = number % 4
    at = int(chance.integers(8, len(found)))
    if kind == 0:
        for place in chance.integers(8, len(found), size=int(chance.integers(1, 12))):
            found[place] = int(chance.integers(256))
    elif kind == 1:
        del found[at : at + int(chance.integers(1, 400))]
    elif kind == 2:
        found[at:at] = found[at : at + int(chance.integers(1, 400))]
    else:
        found[at : at + 8] = int(chance.integers(2**62)).to_bytes(8, "little")  # a length, if it hits one
    return bytes(found)


@pytest.mark.parametrize("compression", ["lz4", "none"])
def test_hostile_bytes_end_quietly_and_soon(tmp_path, system, compression):
    file = tmp_path / "a.mcap"
    write(file, system, rows(60), compression=compression, chunk_bytes=1024)
    data, began_s = file.read_bytes(), time.monotonic()
    for number in range(200):
        file.write_bytes(damaged(data, number))
        try:
            recording = Recording(file)
            recording.session(), recording.launch(), recording.whole(), recording.topics()
            for message in recording.messages():
                message.decoded()
        except ConfigurationError:
            continue
    assert time.monotonic() - began_s < 60
