"""Ways to spoil a file."""

from __future__ import annotations

import random
import struct
from collections.abc import Callable

Mutation = Callable[[bytearray, random.Random], bytearray]
_NASTY = (0, 1, 0x7F, 0xFF, 2**31, 2**32 - 1, 2**63, 2**64 - 1)


def _flip(data: bytearray, rng: random.Random) -> bytearray:
    for _ in range(rng.randint(1, 8)):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return data


def _cut(data: bytearray, rng: random.Random) -> bytearray:
    return data[: rng.randrange(len(data))]


def _drop(data: bytearray, rng: random.Random) -> bytearray:
    at = rng.randrange(len(data))
    del data[at : at + rng.randint(1, 200)]
    return data


def _repeat(data: bytearray, rng: random.Random) -> bytearray:
    at, length = rng.randrange(len(data)), rng.randint(1, 500)
    return data[:at] + data[at : at + length] + data[at:]


def _scribble(data: bytearray, rng: random.Random) -> bytearray:
    at, length = rng.randrange(len(data)), rng.randint(1, 64)
    data[at : at + length] = rng.randbytes(length)
    return data


def _number(data: bytearray, rng: random.Random) -> bytearray:
    """A hostile length somewhere."""
    at, value = rng.randrange(len(data)), rng.choice(_NASTY)
    packed = struct.pack("<Q", value)
    data[at : at + 8] = packed[: rng.choice((2, 4, 8))]
    return data


def _swap(data: bytearray, rng: random.Random) -> bytearray:
    a, b = sorted(rng.randrange(len(data)) for _ in range(2))
    return data[b:] + data[a:b] + data[:a] if rng.random() < 0.1 else data[:a] + data[b:] + data[a:b]


MUTATIONS: tuple[Mutation, ...] = (_flip, _cut, _drop, _repeat, _scribble, _number, _swap)


def mutated(content: bytes, rng: random.Random) -> bytes:
    """One to three mutations of a file, mostly behind its magic."""
    data = bytearray(content)
    for _ in range(rng.randint(1, 3)):
        if data:
            data = rng.choice(MUTATIONS)(data, rng)
    return content[:8] + bytes(data[8:]) if rng.random() < 0.9 else bytes(data)
