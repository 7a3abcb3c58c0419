"""Frame to command, real-time clock: the whole system against a bare chain of as many processes.

A bystander hears the image and the command for it, in both alike; what lies between is the latency. The chain carries
the same payloads through bare zenoh (image, view, percept, trial, drive, command) and runs the same OpenCV calls.
"""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import zenoh
from numpy.typing import NDArray

from benchmarks.figure import Figure
from runtime.bus import direct, free_endpoint, open_peer, open_router
from runtime.launch import load
from runtime.supervise import Supervisor
from runtime.wire import unpack_stamp
from schemas.image_pb2 import CompressedImage

LAUNCH = Path("launch/sim.toml")
FRAMES = 320
"""At 8 Hz: forty seconds for each of the two."""
WARM_UP = 16
PLANNING = ("learner.method=structure-given", "pilot.controller=greedy", "task.action_set=reverse")
"""The most that there is to plan: half a minute of sweeps, a slice after each frame."""
LINKS = (("view", 80, "look"), ("percept", 80, ""), ("trial", 40, ""), ("drive", 30, ""), ("command", 30, ""))
"""What vision, tracker, pilot, grasper and base send: (name, bytes, work)."""
_TIMEOUT_S = 180.0


class Bystander:
    """Notes when an image and the command for it pass by."""

    def __init__(self, session: zenoh.Session, image: str, command: str, frame_of: Callable[[bytes], int]) -> None:
        """Subscribe to both keys; `frame_of` reads a frame's mark from an attachment."""
        self.image = b""
        """The newest: in the first ones the head still searches."""
        self._frame_of = frame_of
        self._images: dict[int, int] = {}
        self._ages_ns: dict[int, int] = {}
        session.declare_subscriber(image, direct(self._see_image))
        session.declare_subscriber(command, direct(self._see_command))

    def _see_image(self, sample: zenoh.Sample) -> None:
        now_ns = time.monotonic_ns()
        if sample.attachment is not None:
            self._images[self._frame_of(sample.attachment.to_bytes())] = now_ns
            self.image = sample.payload.to_bytes()

    def _see_command(self, sample: zenoh.Sample) -> None:
        now_ns = time.monotonic_ns()
        frame = -1 if sample.attachment is None else self._frame_of(sample.attachment.to_bytes())
        if frame in self._images:
            self._ages_ns.setdefault(frame, now_ns - self._images[frame])

    @property
    def count(self) -> int:
        """Frames answered so far."""
        return len(self._ages_ns)

    def ages_ms(self) -> NDArray[np.float64]:
        """Of each answered frame after the warm-up."""
        return np.array(list(self._ages_ns.values())[WARM_UP:]) / 1e6


def system_ages_ms(frames: int, overrides: Sequence[str] = ()) -> tuple[NDArray[np.float64], bytes]:
    """(ages of the system's commands, one of its images as JPEG)."""
    with tempfile.TemporaryDirectory() as folder:
        system = load(LAUNCH, overrides, clock="real", recording=Path(folder) / "latency.mcap")
        system = dataclasses.replace(system, realm=f"benchmark/latency-{os.getpid()}")  # beside one that runs already
        with Supervisor(system) as supervisor, open_peer(supervisor.run.endpoint) as session:
            keys = [f"{system.realm}/{key}" for key in ("camera/image", "base/actuate")]
            bystander = Bystander(session, keys[0], keys[1], lambda attachment: unpack_stamp(attachment).capture_ns)
            _wait(lambda: supervisor.poll(0.2) and bystander.count >= frames + WARM_UP)
            assert not supervisor.deaths, supervisor.deaths
    return bystander.ages_ms(), CompressedImage.FromString(bystander.image).data


def chain_ages_ms(frames: int, image: bytes) -> NDArray[np.float64]:
    """Ages of the bare chain's commands."""
    with tempfile.NamedTemporaryFile() as file, bare_chain(image, Path(file.name)) as bystander:
        _wait(lambda: bystander.count >= frames + WARM_UP)
        return bystander.ages_ms()


@contextmanager
def bare_chain(image: bytes, file: Path) -> Iterator[Bystander]:
    """The chain's processes, and a bystander."""
    file.write_bytes(image)
    endpoint = free_endpoint()
    keys = ["bare/image", *(f"bare/{name}" for name, _, _ in LINKS)]
    with open_router(endpoint), open_peer(endpoint) as session:
        bystander = Bystander(session, keys[0], keys[-1], lambda attachment: int.from_bytes(attachment, "little"))
        links = [
            _process([endpoint, keys[index], keys[index + 1], str(size), *work.split()])
            for index, (_, size, work) in enumerate(LINKS)
        ]
        for process in links:
            assert process.stdout is not None
            process.stdout.readline()
        links.append(_process([endpoint, "source", keys[0], str(file)]))
        try:
            yield bystander
        finally:
            for process in links:
                process.communicate(timeout=10)


def _process(arguments: list[str]) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "benchmarks.chain", *arguments]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)


def _wait(done: Callable[[], bool]) -> None:
    deadline_s = time.monotonic() + _TIMEOUT_S
    while not done():
        assert time.monotonic() < deadline_s, "timed out"
        time.sleep(0.05)


def figures(frames: int = FRAMES) -> list[Figure]:
    """System and floor in one run."""
    system, image = system_ages_ms(frames)
    floor = chain_ages_ms(frames, image)
    found = []
    for share, most in ((50, 1.5), (99, 2.0)):
        ours, bare = float(np.percentile(system, share)), float(np.percentile(floor, share))
        note = f"{ours:.2f} ms against {bare:.2f} ms"
        found.append(Figure(f"frame to command, p{share}", ours / bare, "x the bare chain", at_most=most, note=note))
    return [*found, planning(frames)]


def planning(frames: int) -> Figure:
    """What the learner of our own costs the command while it learns and plans, against the same system at rest."""
    idle, _ = system_ages_ms(frames, (*PLANNING, "pilot.train_s=0"))
    busy, _ = system_ages_ms(frames, PLANNING)
    alone, beside = float(np.percentile(idle, 99)), float(np.percentile(busy, 99))
    note = f"{beside:.2f} ms against {alone:.2f} ms, nothing learned or planned"
    return Figure("frame to command while planning, p99", beside / alone, "x", at_most=1.1, note=note)


def main() -> None:
    """Print the numbers."""
    for figure in figures(*map(int, sys.argv[1:2])):
        sys.stdout.write(f"{figure.name}: {figure.value:.2f} {figure.unit} ({figure.note})\n")


if __name__ == "__main__":
    main()
