"""A message on the bus: bytes, encoding, and an attachment of run id, sequence and capture time. Pure."""

from __future__ import annotations

import math
import secrets
import struct
from collections.abc import Callable, Iterable
from itertools import chain
from operator import attrgetter
from typing import Any, NamedTuple

from google.protobuf.descriptor import Descriptor, FieldDescriptor
from google.protobuf.message import DecodeError

_ATTACHMENT = struct.Struct("<QQq")
_ENCODING = "application/protobuf;"
_REALS = (FieldDescriptor.TYPE_DOUBLE, FieldDescriptor.TYPE_FLOAT)
LARGEST = 1e12
"""No length, angle, speed or value is beyond; its square is still finite in single precision."""
LATEST_NS = 2**62
"""A session of 146 years; what is added to a capture time still fits into 64 bits."""


class Refused(Exception):  # noqa: N818  (a verdict about a message, not a failure of this program)
    """This message is not to be believed; the text says why."""


class Stamp(NamedTuple):
    """Who sent a message, which of its messages it is, and when the light or the encoder was read."""

    run: int
    sequence: int
    capture_ns: int


def new_run() -> int:
    """A run id: 64 random bits, never 0, which stands for the shell itself."""
    return secrets.randbits(64) or 1


def pack_stamp(run: int, sequence: int, capture_ns: int) -> bytes:
    """The attachment of one message."""
    return _ATTACHMENT.pack(run, sequence, capture_ns)


def unpack_stamp(attachment: bytes) -> Stamp:
    """Inverse of `pack_stamp`.

    Raises:
        Refused: wrong length, run 0, or a capture time before the session or after every session.
    """
    if len(attachment) != _ATTACHMENT.size:
        raise Refused(f"attachment must have {_ATTACHMENT.size} bytes; got {len(attachment)}")
    stamp = Stamp(*_ATTACHMENT.unpack(attachment))
    if stamp.run == 0 or not 0 <= stamp.capture_ns < LATEST_NS:
        raise Refused(f"attachment must name a run and a capture time of a session; got {stamp}")
    return stamp


def encoding_of(schema: type[Any]) -> str:
    """What a publisher says about its payload, e.g. `application/protobuf;berth.Percept`."""
    return encoding_of_name(schema.DESCRIPTOR.full_name)


def encoding_of_name(full_name: str) -> str:
    """The same for a schema's full name, e.g. of a message that this release does not know."""
    return f"{_ENCODING}{full_name}"


def schema_name(encoding: str) -> str:
    """Inverse of `encoding_of`: the schema's full name, empty if it is no protobuf."""
    return encoding.removeprefix(_ENCODING) if encoding.startswith(_ENCODING) else ""


class Decoder:
    """Makes messages of one schema from payloads; looks the schema's fields up once, since it runs per message."""

    def __init__(self, schema: type[Any]) -> None:
        """For a generated protobuf class."""
        self._schema = schema
        self._possible = _range_check(schema.DESCRIPTOR)

    def __call__(self, payload: bytes) -> Any:
        """The message in a payload.

        Raises:
            Refused: not a message of this schema, or a number in it is not finite or absurd.
        """
        try:
            message = self._schema.FromString(payload)
        except DecodeError:
            raise Refused(f"payload of {len(payload)} bytes is no {self._schema.DESCRIPTOR.full_name}") from None
        if not self._possible(message):
            raise Refused(
                f"{self._schema.DESCRIPTOR.full_name} holds a number that is not finite, or beyond {LARGEST:g}"
            )
        return message


def _range_check(descriptor: Descriptor) -> Callable[[Any], bool]:
    """Whether all real numbers of a message are finite and possible.

    Judged by the root of their squares' sum, one call for all of them; a comparison with NaN is false.
    """
    single = [field.name for field in descriptor.fields if field.type in _REALS and not field.is_repeated]
    listed = [field.name for field in descriptor.fields if field.type in _REALS and field.is_repeated]
    nested = [(field, _range_check(field.message_type)) for field in descriptor.fields if field.message_type]
    # attrgetter returns a bare value for one name and a tuple for more: ask for the first one twice.
    scalars: Callable[[Any], tuple[float, ...]] = attrgetter(single[0], *single) if single else lambda _: ()

    def check(message: Any) -> bool:
        lists: Iterable[float] = chain.from_iterable(getattr(message, name) for name in listed)
        if not (math.hypot(*scalars(message)) < LARGEST and math.hypot(*lists) < LARGEST):
            return False
        return all(inner(part) for field, inner in nested for part in _parts(message, field))

    return check


def _parts(message: Any, field: FieldDescriptor) -> Iterable[Any]:
    if field.is_repeated:
        parts: Iterable[Any] = getattr(message, field.name)
        return parts
    return (getattr(message, field.name),) if message.HasField(field.name) else ()
