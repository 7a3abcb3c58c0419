"""Named arrays with a header as one block of bytes: self-describing, not executable, safe to read from strangers.

Layout: MAGIC, header length (uint32, little-endian), header (JSON), the arrays one after another (little-endian, C
order), SHA-256 of everything before it.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

MAGIC = b"BERTH\x00\x01\n"
LARGEST_BYTES = 64 * 1024 * 1024
"""More is refused unread: a learner's whole state is below 2 MB."""
_TYPES = ("<f8", "<f4", "<i8", "<i4", "<u4", "|i1", "|b1")
_DIGEST_BYTES = 32


class Packed(NamedTuple):
    """What `unpack` returns."""

    header: dict[str, Any]
    arrays: dict[str, NDArray[Any]]


def pack(kind: str, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """The bytes of a header (anything JSON can say) and named arrays; the same contents give the same bytes."""
    stored = {name: _little_endian(array) for name, array in arrays.items()}
    layout = [[name, array.dtype.str, list(array.shape)] for name, array in stored.items()]
    text = json.dumps(
        {"kind": kind, "header": dict(header), "arrays": layout}, sort_keys=True, allow_nan=False
    ).encode()
    body = MAGIC + len(text).to_bytes(4, "little") + text + b"".join(array.tobytes() for array in stored.values())
    return body + hashlib.sha256(body).digest()


def unpack(data: bytes, kind: str) -> Packed:
    """Header and arrays out of `pack`'s bytes.

    Raises:
        ValueError: not such bytes, damaged, of another kind, or too large; says which.
    """
    if not data.startswith(MAGIC):
        raise ValueError(f"not a Berth {kind}: it must begin with {MAGIC!r}")
    if len(data) > LARGEST_BYTES:
        raise ValueError(f"{kind} must be at most {LARGEST_BYTES} bytes; got {len(data)}")
    body, digest = data[:-_DIGEST_BYTES], data[-_DIGEST_BYTES:]
    if hashlib.sha256(body).digest() != digest:
        raise ValueError(f"{kind} is damaged: its SHA-256 does not fit")
    start = len(MAGIC) + 4
    end = start + int.from_bytes(body[len(MAGIC) : start], "little")
    try:
        described = json.loads(body[start:end])
        if described["kind"] != kind:
            raise ValueError(f"expected a {kind}; got a {described['kind']}")
        return Packed(dict(described["header"]), _arrays(body, end, described["arrays"]))
    except (KeyError, TypeError, RecursionError, UnicodeDecodeError) as error:
        raise ValueError(f"{kind} has an unreadable header: {error}") from error


def _little_endian(array: NDArray[Any]) -> NDArray[Any]:
    stored = np.ascontiguousarray(array)
    return stored.astype(stored.dtype.newbyteorder("<"), copy=False)


def _arrays(body: bytes, offset: int, layout: list[Any]) -> dict[str, NDArray[Any]]:
    arrays: dict[str, NDArray[Any]] = {}
    for name, kind, shape in layout:
        if kind not in _TYPES or not all(type(n) is int and n >= 0 for n in shape):
            raise ValueError(
                f"array {name!r} must have a type of {', '.join(_TYPES)} and a shape; got {kind!r} {shape!r}"
            )
        count = math.prod(shape)
        size = count * np.dtype(kind).itemsize
        if offset + size > len(body):
            raise ValueError(f"array {name!r} is longer than the data")
        arrays[str(name)] = np.frombuffer(body, np.dtype(kind), count, offset).reshape(shape).copy()
        offset += size
    if offset != len(body):
        raise ValueError(f"{len(body) - offset} bytes are left over")
    return arrays
