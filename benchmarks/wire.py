"""A bad radio between two machines: a process that carries IP packets between two TUN devices, and loses some.

The kernel's own `netem` does the same; kernels without it (containers, small virtual machines) still have TUN. Packets
that are lost here are repeated by the machines' own TCP, as over the air. Packets stay in order, as a radio's link
layer keeps them, and each is delayed by a number drawn from 0 to `jitter_s`, or more if one before it was. The rate is
not limited here but by `tc tbf` at both ends. Time is that of a user's process: on a busy machine, some ms more.

    python -m benchmarks.wire DEVICE DEVICE     both are made and die with it; each line on standard input is a Quality
"""

from __future__ import annotations

import contextlib
import fcntl
import heapq
import json
import os
import random
import select
import struct
import subprocess
import sys
import time
from types import TracebackType
from typing import NamedTuple, Self

_TUNSETIFF, _IFF_TUN_NO_PI = 0x400454CA, 0x1001
"""linux/if_tun.h"""
_PACKET_BYTES = 65536
_SEED = 1


class Quality(NamedTuple):
    """What a wire does to each packet, in either direction."""

    loss: float = 0.0
    """Share of packets that never arrive."""
    jitter_s: float = 0.0


GOOD = Quality()


class Wire:
    """The process, seen from outside. Ends with the context."""

    def __init__(self, near: str, far: str) -> None:
        """Make both devices, in this process's network namespace: they may be moved to others.

        Raises:
            OSError: there are no TUN devices here, or they may not be made.
        """
        command = [sys.executable, "-m", "benchmarks.wire", near, far]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        if self._process.stdout.readline() != "ready\n":
            self._process.wait()
            raise OSError(f"no TUN device can be made here (exit code {self._process.returncode})")

    def become(self, quality: Quality) -> None:
        """From the next packet on."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(quality._asdict()) + "\n")
        self._process.stdin.flush()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Both devices vanish."""
        self._process.communicate()


class Packets:
    """Decides what becomes of each packet."""

    def __init__(self, seed: int) -> None:
        """A good wire."""
        self.quality = GOOD
        self._chance = random.Random(seed)
        self._way: list[tuple[float, int, int, bytes]] = []
        self._last_s = [0.0, 0.0]
        self._count = 0

    def enter(self, end: int, packet: bytes, now_s: float) -> None:
        """A packet for this end (0 or 1) was sent."""
        if self._chance.random() < self.quality.loss:
            return
        self._count += 1
        self._last_s[end] = max(self._last_s[end], now_s + self._chance.uniform(0.0, self.quality.jitter_s))
        heapq.heappush(self._way, (self._last_s[end], self._count, end, packet))

    def due_s(self) -> float | None:
        """When the next one arrives."""
        return self._way[0][0] if self._way else None

    def leave(self, now_s: float) -> list[tuple[int, bytes]]:
        """(end, packet) of those that have arrived."""
        arrived = []
        while self._way and self._way[0][0] <= now_s:
            _, _, end, packet = heapq.heappop(self._way)
            arrived.append((end, packet))
        return arrived


def _tun(name: str) -> int:
    descriptor = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(descriptor, _TUNSETIFF, struct.pack("16sH", name.encode(), _IFF_TUN_NO_PI))
    return descriptor


def _carry(ends: list[int]) -> None:
    """Until standard input ends."""
    packets, control = Packets(_SEED), sys.stdin.fileno()
    while True:
        due_s = packets.due_s()
        wait_s = None if due_s is None else max(0.0, due_s - time.monotonic())
        ready, _, _ = select.select([*ends, control], [], [], wait_s)
        if control in ready:
            line = sys.stdin.readline()
            if not line:
                return
            packets.quality = Quality(**json.loads(line))
        for end, descriptor in enumerate(ends):
            if descriptor in ready:
                with contextlib.suppress(OSError):  # nothing more, or its device is down
                    packets.enter(1 - end, os.read(descriptor, _PACKET_BYTES), time.monotonic())
        for end, packet in packets.leave(time.monotonic()):
            with contextlib.suppress(OSError):  # its device is down: lost
                os.write(ends[end], packet)


def main() -> None:
    """Carry packets."""
    ends = [_tun(name) for name in sys.argv[1:3]]
    print("ready", flush=True)
    _carry(ends)


if __name__ == "__main__":
    main()
