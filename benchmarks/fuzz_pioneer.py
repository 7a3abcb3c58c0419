"""Ten thousand spoiled byte streams through the readers of the robot's line: no crash, no whole packet lost."""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Sequence
from typing import NamedTuple

from benchmarks.figure import Figure
from components.base.pioneer.command import heard
from components.base.pioneer.config_pac import config_of
from components.base.pioneer.frame import Frames, framed
from components.base.pioneer.gripper_pac import gripper_of
from components.base.pioneer.sip import sip_of

STREAMS = 10_000
SEED = 20051122
_HELD_BYTES = 260
"""One packet and what came with it."""


class Stream(NamedTuple):
    """Bytes as a line might bring them, in pieces, and the packets in them that are whole."""

    pieces: Sequence[bytes]
    payloads: Sequence[bytes]


def stream(rng: random.Random) -> Stream:
    """Whole packets among spoiled ones, cut anywhere."""
    parts, payloads = [], []
    for _ in range(rng.randrange(1, 12)):
        if rng.random() < 0.5:
            payloads.append(rng.randbytes(rng.choice((1, 4, 9, 40, 198))))
            parts.append(framed(payloads[-1]))
        else:
            parts.append(_spoiled(rng))
    return Stream(_cut(b"".join(parts), rng), payloads)


def _spoiled(rng: random.Random) -> bytes:
    """A packet with one thing wrong, or no packet."""
    good = bytearray(framed(rng.randbytes(rng.randrange(1, 60))))
    kind = rng.randrange(6)
    if kind == 0:
        return rng.randbytes(rng.randrange(1, 80))
    if kind == 1:
        return bytes(good[: rng.randrange(1, len(good))])
    if kind == 2:
        return b"\xfa\xfb" + bytes((rng.choice((0, 1, 2, 3, 200, 254, 255)),))
    if kind == 3:
        return b"\xfa" * rng.randrange(1, 9) + b"\xfb" * rng.randrange(3)
    at = -1 if kind == 4 else rng.randrange(len(good))
    good[at] ^= 1 << rng.randrange(8)
    return bytes(good)


def _cut(data: bytes, rng: random.Random) -> list[bytes]:
    cuts = sorted(rng.randrange(len(data) + 1) for _ in range(rng.randrange(8)))
    return [data[a:b] for a, b in zip([0, *cuts], [*cuts, len(data)], strict=True)]


def lost(sent: Stream, read: Sequence[bytes]) -> int:
    """Whole packets that were not read, in their order; what else was read does not matter."""
    at, missing = 0, 0
    for payload in sent.payloads:
        try:
            at = read.index(payload, at) + 1
        except ValueError:
            missing += 1
    return missing


def run(streams: int, seed: int) -> tuple[int, int, int, int]:
    """(crashes, packets sent, packets lost, most bytes held)."""
    rng = random.Random(seed)
    crashes = sent = missing = held = 0
    for number in range(streams):
        case, frames, read = stream(rng), Frames(), []
        try:
            for piece in case.pieces:
                read += frames.feed(piece)
                held = max(held, frames.waiting)
            while more := frames.settle():
                read += more
            for payload in read:
                understood(payload)
        except Exception as error:  # noqa: BLE001  (what must not happen is counted and shown)
            crashes += 1
            sys.stderr.write(f"stream {number}: {type(error).__name__}: {error}\n")
        sent += len(case.payloads)
        missing += lost(case, read)
    return crashes, sent, missing, held


def understood(payload: bytes) -> None:
    """Every reader of a payload."""
    for kind in (0x20, 0x32, 0x33, 0xE0, payload[0]):
        changed = bytes((kind,)) + payload[1:]
        heard(changed), sip_of(changed), config_of(changed), gripper_of(changed)


def figures() -> list[Figure]:
    """See the module."""
    began_s = time.perf_counter()
    crashes, sent, missing, held = run(STREAMS, SEED)
    return [
        Figure("streams", STREAMS, at_least=10_000, note=f"{time.perf_counter() - began_s:.0f} s"),
        Figure("crashes", crashes, at_most=0),
        Figure("whole packets lost", missing, at_most=0, note=f"of {sent}"),
        Figure("bytes held", held, at_most=_HELD_BYTES),
    ]
