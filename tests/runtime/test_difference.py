"""What differs between two messages."""

import math

import pytest

from runtime.difference import differences
from schemas.drive_pb2 import GRIPPER_CLOSE, GRIPPER_LIFT, BaseCommand
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import Journal


def told(schema, a, b, **options):
    payloads = (a.SerializeToString(), b.SerializeToString())
    return [tuple(difference) for difference in differences(schema, *payloads, **options)]


def test_equal_messages_do_not_differ():
    assert told("berth.BaseCommand", BaseCommand(v_mps=1.0), BaseCommand(v_mps=1.0)) == []


def test_each_field_is_named_with_both_values():
    a, b = BaseCommand(v_mps=1.0, gripper=GRIPPER_CLOSE), BaseCommand(v_mps=2.0, gripper=GRIPPER_LIFT)
    assert told("berth.BaseCommand", a, b) == [
        ("v_mps", "1.0", "2.0"),
        ("gripper", "GRIPPER_CLOSE", "GRIPPER_LIFT"),
    ]


def test_lists_are_compared_entry_by_entry_and_by_length():
    a, b = Journal(port=[1, 2, 3]), Journal(port=[1, 9])
    assert told("berth.Journal", a, b) == [("port", "3 entries", "2 entries"), ("port[1]", "2", "9")]


def test_bytes_are_shown_from_where_they_differ():
    ((field, a, b),) = told("berth.Policy", Policy(action=b"\0\1\2"), Policy(action=b"\0\1\3"))
    assert (field, a, b) == ("action", "3 bytes, from byte 2: 02", "3 bytes, from byte 2: 03")


def test_numbers_that_are_both_no_number_are_equal_but_their_bits_are_not():
    quiet = BaseCommand(v_mps=math.nan).SerializeToString()
    other = quiet[:-1] + bytes([quiet[-1] ^ 0x80])
    assert [d.field for d in differences("berth.BaseCommand", quiet, other)] == ["bytes"]
    assert differences("berth.BaseCommand", quiet, other, tolerant=True) == ()


@pytest.mark.parametrize(("now", "same"), [(1.0 + 1e-9, True), (1.0 + 1e-4, False), (math.nan, False)])
def test_a_tolerance_forgives_rounding_alone(now, same):
    found = told("berth.BaseCommand", BaseCommand(v_mps=1.0), BaseCommand(v_mps=now), tolerant=True)
    assert (found == []) is same


def test_a_message_of_an_unknown_schema_is_compared_by_its_bytes():
    assert [d.field for d in differences("other.Thing", b"ab", b"ac")] == ["bytes"]


def test_damaged_bytes_are_a_difference():
    good = BaseCommand(v_mps=1.0).SerializeToString()
    assert [d.field for d in differences("berth.BaseCommand", good, good[:-1])] == ["bytes"]
