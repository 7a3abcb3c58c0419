"""Whatever comes on any port of any component: a possible message, or refused at the door."""

import math
import os
import random
from pathlib import Path

import pytest
from google.protobuf.descriptor import FieldDescriptor
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.contract import Port
from runtime.system import ports_of
from runtime.wire import LARGEST, Decoder, Refused

ROOT = Path(__file__).parents[2]
PORTS = {
    f"{file.parent.name}/{name}": port.schema
    for file in sorted((ROOT / "components").glob("*/ports.py"))
    for table in ("INPUTS", "OUTPUTS")
    for name, port in getattr(ports_of(f"components.{file.parent.name}"), table, {}).items()
    if isinstance(port, Port)
}
REALS = {FieldDescriptor.CPPTYPE_DOUBLE, FieldDescriptor.CPPTYPE_FLOAT}
NUMBERS = st.sampled_from([0.0, 1.0, -0.5, math.nan, math.inf, -math.inf, 1e13, -1e300, 3e38, 5e-324])
PLAIN = {
    FieldDescriptor.CPPTYPE_INT32: st.integers(-(2**31), 2**31 - 1),
    FieldDescriptor.CPPTYPE_INT64: st.integers(-(2**63), 2**63 - 1),
    FieldDescriptor.CPPTYPE_UINT32: st.integers(0, 2**32 - 1),
    FieldDescriptor.CPPTYPE_UINT64: st.integers(0, 2**64 - 1),
    FieldDescriptor.CPPTYPE_BOOL: st.booleans(),
    FieldDescriptor.CPPTYPE_ENUM: st.integers(-1, 99),
    FieldDescriptor.CPPTYPE_DOUBLE: NUMBERS,
    FieldDescriptor.CPPTYPE_FLOAT: NUMBERS.filter(lambda x: not math.isfinite(x) or abs(x) < 3.5e38),
}


def value_of(draw, field):
    if field.message_type is not None:
        return filled(draw, field.message_type._concrete_class())
    if field.cpp_type == FieldDescriptor.CPPTYPE_STRING:
        return draw(st.binary(max_size=8) if field.type == FieldDescriptor.TYPE_BYTES else st.text(max_size=8))
    return draw(PLAIN[field.cpp_type])


def filled(draw, message):
    """The message with some of its fields set to anything that fits into them."""
    for field in message.DESCRIPTOR.fields:
        if not draw(st.booleans()):
            continue
        if field.is_repeated:
            values = [value_of(draw, field) for _ in range(draw(st.integers(0, 2)))]
            getattr(message, field.name).extend(values)
        elif field.message_type is not None:
            getattr(message, field.name).CopyFrom(value_of(draw, field))
        else:
            setattr(message, field.name, value_of(draw, field))
    return message


def reals(message):
    """Every real number in a message, wherever it stands."""
    for field, value in message.ListFields():
        values = value if field.is_repeated else [value]
        if field.message_type is not None:
            for part in values:
                yield from reals(part)
        elif field.cpp_type in REALS:
            yield from values


@pytest.mark.parametrize("name", PORTS)
@settings(max_examples=30)
@given(st.data())
def test_a_message_is_possible_or_refused(name, data):
    sent = filled(data.draw, PORTS[name]())
    try:
        received = Decoder(PORTS[name])(sent.SerializeToString())
    except Refused:
        assert not all(abs(number) < LARGEST for number in reals(sent))
        return
    assert received == sent
    assert all(abs(number) < LARGEST for number in reals(received))


@pytest.mark.parametrize("name", PORTS)
def test_damaged_bytes_are_a_possible_message_or_refused(name):
    """BERTH_FUZZ says how many for each port."""
    chance, schema, refused = random.Random(name), PORTS[name], 0
    for _ in range(int(os.environ.get("BERTH_FUZZ", "200"))):
        payload = chance.randbytes(chance.randrange(64))
        try:
            assert all(abs(number) < LARGEST for number in reals(Decoder(schema)(payload)))
        except Refused:
            refused += 1
    assert refused > 0
