"""What differs between two messages, field by field."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from google.protobuf.descriptor import FieldDescriptor
from google.protobuf.message import DecodeError

from runtime.messages import message_class

TOLERANCE = 1e-6
"""Of real numbers computed on another machine, relative to the larger of them and 1."""
_SHOWN = 60
_MOST = 4
"""Fields shown of one message."""


class FieldDifference(NamedTuple):
    """One field of a message, in words."""

    field: str
    recorded: str
    replayed: str


def differences(
    schema: str, recorded: bytes, replayed: bytes, *, tolerant: bool = False
) -> tuple[FieldDifference, ...]:
    """The first few fields that differ; empty if the messages are equal.

    Args:
        schema: full name of both messages.
        recorded: payload in the session.
        replayed: payload now.
        tolerant: real numbers may differ by `TOLERANCE`, and bytes (tables, hashes) in all but their length.
    """
    if recorded == replayed:
        return ()
    raw = FieldDifference("bytes", *_shown_bytes(recorded, replayed))
    kind = message_class(schema)
    if kind is None:
        return (raw,)
    try:
        before, now = kind.FromString(recorded), kind.FromString(replayed)
    except DecodeError:
        return (raw,)
    found = tuple(itertools.islice(_compared(before, now, tolerant), _MOST))
    return found if found or tolerant else (raw,)


def _compared(a: Any, b: Any, tolerant: bool, prefix: str = "") -> Iterator[FieldDifference]:
    for field in a.DESCRIPTOR.fields:
        name = prefix + field.name
        x, y = getattr(a, field.name), getattr(b, field.name)
        if not field.is_repeated:
            yield from _compared_value(field, name, x, y, tolerant)
            continue
        if len(x) != len(y):
            yield FieldDifference(name, f"{len(x)} entries", f"{len(y)} entries")
        for index, (p, q) in enumerate(zip(x, y, strict=False)):
            yield from _compared_value(field, f"{name}[{index}]", p, q, tolerant)


def _compared_value(field: FieldDescriptor, name: str, x: Any, y: Any, tolerant: bool) -> Iterator[FieldDifference]:
    if field.message_type is not None:
        yield from _compared(x, y, tolerant, name + ".")
    elif isinstance(x, bytes):
        if len(x) != len(y) if tolerant else x != y:
            yield FieldDifference(name, *_shown_bytes(x, y))
    elif x != y and not (isinstance(x, float) and _same(x, y, tolerant)):
        yield FieldDifference(name, _shown(field, x), _shown(field, y))


def _same(x: float, y: float, tolerant: bool) -> bool:
    if math.isnan(x) and math.isnan(y):
        return True
    return tolerant and abs(x - y) <= TOLERANCE * max(1.0, abs(x), abs(y))


def _shown(field: FieldDescriptor, value: Any) -> str:
    if field.enum_type is not None and value in field.enum_type.values_by_number:
        return str(field.enum_type.values_by_number[value].name)
    text = repr(value)
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def _shown_bytes(x: bytes, y: bytes) -> tuple[str, str]:
    at = next((i for i, (p, q) in enumerate(zip(x, y, strict=False)) if p != q), min(len(x), len(y)))
    before, now = (f"{len(part)} bytes, from byte {at}: {part[at : at + 8].hex() or '-'}" for part in (x, y))
    return before, now
