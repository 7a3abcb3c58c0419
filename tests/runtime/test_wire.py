"""Bytes on the bus, and what is refused."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.sequence import Sequences
from runtime.wire import Decoder, Refused, encoding_of, new_run, pack_stamp, schema_name, unpack_stamp
from schemas.drive_pb2 import Drive
from schemas.image_pb2 import CompressedImage
from schemas.policy_pb2 import Policy


@given(st.integers(1, 2**64 - 1), st.integers(0, 2**64 - 1), st.integers(0, 2**62 - 1))
def test_a_stamp_survives_its_bytes(run, sequence, capture_ns):
    assert unpack_stamp(pack_stamp(run, sequence, capture_ns)) == (run, sequence, capture_ns)


@given(st.binary(max_size=40))
def test_any_attachment_is_a_stamp_or_refused(attachment):
    try:
        stamp = unpack_stamp(attachment)
    except Refused:
        return
    assert stamp.run > 0
    assert stamp.capture_ns >= 0


def test_run_ids_are_never_zero_and_differ():
    assert 0 not in {new_run() for _ in range(100)}
    assert len({new_run() for _ in range(100)}) == 100


def test_the_encoding_names_the_schema():
    assert encoding_of(CompressedImage) == "application/protobuf;foxglove.CompressedImage"
    assert schema_name(encoding_of(CompressedImage)) == "foxglove.CompressedImage"
    assert schema_name("text/plain") == ""


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(
    "message",
    [lambda bad: Drive(omega_radps=bad), lambda bad: Policy(value=[0.0, bad]), lambda bad: Policy(beta_range_rad=bad)],
)
def test_a_number_that_is_not_finite_is_refused_wherever_it_stands(message, bad):
    payload = message(bad).SerializeToString()
    with pytest.raises(Refused, match="not finite"):
        Decoder(message(bad).__class__)(payload)


@pytest.mark.parametrize("absurd", [2e12, -3e38])
def test_a_number_beyond_every_length_and_speed_is_refused(absurd):
    for message in (Drive(v_mps=absurd), Policy(value=[0.0, absurd])):
        with pytest.raises(Refused, match="beyond 1e\\+12"):
            Decoder(message.__class__)(message.SerializeToString())


def test_a_capture_time_after_every_session_is_refused():
    assert unpack_stamp(pack_stamp(1, 0, 2**62 - 1)).capture_ns == 2**62 - 1
    for capture_ns in (2**62, 2**63 - 1, -1):
        with pytest.raises(Refused, match="a capture time of a session"):
            unpack_stamp(pack_stamp(1, 0, capture_ns))


@given(st.binary(max_size=200), st.sampled_from([Drive, CompressedImage, Policy]))
def test_any_bytes_are_a_message_or_refused(payload, schema):
    try:
        message = Decoder(schema)(payload)
    except Refused:
        return
    assert isinstance(message, schema)


def test_what_was_packed_is_decoded():
    drive = Drive(engaged=True, v_mps=0.1, omega_radps=-0.2)
    assert Decoder(Drive)(drive.SerializeToString()) == drive


def test_a_hole_in_a_sequence_is_counted():
    sequences = Sequences()
    sequences.expect(7, 0)
    for sequence in (0, 1, 4, 5, 9):
        sequences.receive(7, sequence)
    assert sequences.lost == 2 + 3


def test_the_first_messages_of_a_run_can_be_lost_too():
    sequences = Sequences()
    sequences.expect(7, 0)
    sequences.receive(7, 3)
    assert sequences.lost == 3


def test_a_run_that_began_before_us_is_counted_from_its_first_message():
    sequences = Sequences()
    sequences.expect(7, None)
    sequences.receive(7, 1000)
    sequences.receive(7, 1002)
    assert sequences.lost == 1


def test_a_message_that_comes_twice_is_refused():
    sequences = Sequences()
    sequences.expect(7, 0)
    sequences.receive(7, 0)
    with pytest.raises(Refused, match="sequence 0 came after 0"):
        sequences.receive(7, 0)


def test_a_run_that_nobody_announced_is_refused_and_the_memory_of_runs_is_bounded():
    sequences = Sequences()
    for run in range(1, 101):
        sequences.expect(run, 0)
    with pytest.raises(Refused, match="was not announced"):
        sequences.receive(1, 0)
    sequences.receive(100, 0)
