"""Everything in Berth that reads bytes of strangers, each as one function of bytes, and good bytes to begin with."""

from __future__ import annotations

import functools
import hashlib
import importlib
import os
import random
import struct
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np

from benchmarks import fuzz_pioneer
from cli.main import COMPLAINT, app
from components.base.pioneer.frame import Frames
from components.base.ros2 import codec
from components.base.ros2.odometry import odometry_of
from components.vision import jpeg
from docking.cells import Grid
from docking.policy import PolicyTable
from docking.task import Task
from runtime.contract import Port
from runtime.launch import load
from runtime.link import checked_link
from runtime.log import LogWriter
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.system import ports_of
from runtime.wire import Decoder, Refused, unpack_stamp

ROOT = Path(__file__).parent.parent
_SIZE_PX = (320, 240)
_DIGEST_BYTES = 32
_STAMP_BYTES = 24
_CDR = b"\0\1\0\0"
_STATEFUL = ("tracker", "pilot", "learner")


class Reader(NamedTuple):
    """Who reads, and how it says no."""

    read: Callable[[bytes], object]
    refuses: tuple[type[Exception], ...]
    seeds: Callable[[], Iterable[bytes]]


def survives(reader: Reader, data: bytes) -> bool:
    """Whether the bytes were read; False if they were refused in one line.

    Raises:
        Exception: whatever must not happen.
    """
    try:
        reader.read(data)
    except reader.refuses as refusal:
        if isinstance(refusal, ConfigurationError) and "\n" in str(refusal):
            raise AssertionError(f"more than one line: {refusal}") from refusal
        return False
    return True


@functools.cache
def _schemas() -> list[type[Any]]:
    """Of every port of every component."""
    names = sorted(file.parent.name for file in (ROOT / "components").glob("*/ports.py"))
    tables = [ports_of(f"components.{name}") for name in names]
    ports = [port for table in tables for port in (*table.INPUTS.values(), *table.OUTPUTS.values())]
    return sorted({port.schema for port in ports if isinstance(port, Port)}, key=lambda kind: kind.DESCRIPTOR.full_name)


@functools.cache
def _doors() -> list[Decoder]:
    return [Decoder(schema) for schema in _schemas()]


def _port(data: bytes) -> None:
    """The first byte says which; the last ones are the attachment."""
    doors = _doors()
    doors[data[0] % len(doors) if data else 0](data[1:-_STAMP_BYTES])
    unpack_stamp(data[-_STAMP_BYTES:])


def _messages() -> Iterable[bytes]:
    """One of each schema, out of a session if there is one in it."""
    stamp = bytes([1, 0, 0, 0, 0, 0, 0, 0] * (_STAMP_BYTES // 8))
    names = [schema.DESCRIPTOR.full_name for schema in _schemas()]
    found = {logged.schema: logged.payload for logged in Recording(ROOT / "recordings" / "docking.mcap").messages()}
    return [bytes([number]) + found.get(name, b"") + stamp for number, name in enumerate(names)]


def _in_file(suffix: str, read: Callable[[Path], object]) -> Callable[[bytes], object]:
    @functools.cache
    def place() -> tempfile.TemporaryDirectory[str]:
        home = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # noqa: S108  (a name of its own in it)
        return tempfile.TemporaryDirectory(prefix="berth-fuzz-", dir=home)

    def read_file(data: bytes) -> object:
        file = Path(place().name) / f"case.{suffix}"
        file.write_bytes(data)
        return read(file)

    return read_file


def _recording(file: Path) -> None:
    recording = Recording(file)
    recording.session(), recording.launch(), recording.whole()
    for logged in recording.messages():
        logged.decoded()


def _recordings() -> Iterable[bytes]:
    """A few messages, whole, in each compression."""
    system = load("sim")
    for compression in ("none", "lz4", "zstd"):
        with tempfile.TemporaryDirectory() as folder:
            log = LogWriter(Path(folder) / "a.mcap", system, started="", compression=compression)
            for number in range(3):
                log.write("base/applied", "berth.Applied", bytes(8), 7, number, number, number)
            log.close()
            yield (Path(folder) / "a.mcap").read_bytes()


def _serial(data: bytes) -> None:
    frames = Frames()
    packets = frames.feed(data)
    while more := frames.settle():
        packets += more
    for payload in packets:
        fuzz_pioneer.understood(payload)


_ROS = (codec.BOOL, codec.KOBUKI, codec.HAZARDS, codec.BATTERY)


def _ros(data: bytes) -> None:
    """A ROS 2 base's messages; the first byte says which."""
    which = data[0] % (len(_ROS) + 1) if data else 0
    if which == len(_ROS):
        odometry_of(data[1:])
    else:
        codec.decoded(_ROS[which], data[1:])


def _ros_messages() -> Iterable[bytes]:
    """Small ones by hand, and odometry with the longest of all layouts: 13 numbers of 8 bytes, and two times 36."""
    header = bytes(8) + b"\x05\0\0\0odom\0"
    battery = header + bytes(31) + b"\1\1\1\1" + bytes(8) + b"\1\0\0\0\0" + bytes(3) + b"\1\0\0\0\0"
    small = (b"\1", b"\1\1", header + bytes(7), battery)
    pose = struct.pack("<7d", 1.0, 2.0, 0.0, 0.0, 0.0, 0.6, 0.8) + bytes(36 * 8)
    odometry = header + bytes(3) + b"\x05\0\0\0base\0" + bytes(3) + pose + bytes((6 + 36) * 8)
    return [bytes([which]) + _CDR + content for which, content in enumerate((*small, odometry))]


def _image() -> Iterable[bytes]:
    picture = np.random.default_rng(1).integers(0, 255, (_SIZE_PX[1] // 8, _SIZE_PX[0] // 8, 3), np.uint8)
    large = cv2.resize(picture, _SIZE_PX)
    return [cv2.imencode(".jpg", large, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes() for quality in (20, 80)]


def sealed(data: bytes) -> bytes:
    """With the digest that belongs to it: else nothing behind it is ever reached."""
    body = data[:-_DIGEST_BYTES]
    return body + hashlib.sha256(body).digest()


def _policies() -> Iterable[bytes]:
    task = Task()
    grid = Grid.of(task)
    action = np.zeros(grid.count, np.int8)
    return [PolicyTable(grid, action, np.zeros(grid.count), task.actions, 7, "lc", 12, b"\x01").to_bytes()]


@functools.cache
def _folds() -> list[Any]:
    """One of each component that keeps a state, with its usual parameters."""
    system = load("sim")
    specs = [system.component(name) for name in _STATEFUL]
    classes = [getattr(importlib.import_module(f"{spec.run}.component"), spec.name.capitalize()) for spec in specs]
    return [made(ports_of(spec.run).Params(), 1) for made, spec in zip(classes, specs, strict=True)]


def _snapshot(data: bytes) -> None:
    """The first byte says whose."""
    folds = _folds()
    which = data[0] % len(folds) if data else 0
    state = sealed(data[1:]) if _STATEFUL[which] == "learner" else data[1:]
    folds[which].load(state)
    folds[which].save()


def _snapshots() -> Iterable[bytes]:
    return [bytes([which]) + fold.save() for which, fold in enumerate(_folds())]


def _words(data: bytes) -> None:
    """A command line, one word a line; it is understood and not run."""
    words = data.decode("utf-8", "replace").split("\n")
    if any("completion" in word for word in words):  # would write into the shell's start file at once
        return
    command: Any = importlib.import_module("typer").main.get_command(app)
    context = command.make_context("berth", words, resilient_parsing=False)
    while rest := [*context._protected_args, *context.args]:  # noqa: SLF001  (typer has no other way to look)
        name, command, rest = command.resolve_command(context, rest)
        context = command.make_context(name, rest)


def _settings(data: bytes) -> None:
    """What stands behind --set, --listen and --connect."""
    lines = data.decode("utf-8", "replace").split("\n")
    load(ROOT / "launch" / "sim.toml", lines[2:])
    checked_link(lines[0], "".join(lines[1:2]), insecure=True, tls=False)


_TYPED = (
    b"run\nlaunch/sim.toml\n--duration\n60\n--set\npilot.train_s=60",
    b"play\nrecordings/a.mcap\n-r\n2\n--topics\nbase/applied",
    b"topic\necho\nbase/applied",
    b"view\nrecordings/a.mcap\n--web\n--port\n9090",
)
_SET = (
    b"tcp/0.0.0.0:7447\n\npilot.train_s=60\ntask.action_set=reverse",
    b"\n\nlearner.method=structure-given\nsession.seed=3",
    b"\ntcp/[::1]:7447\nbase.stop_when_gone=['pilot']",
)
READERS = {
    "ports": Reader(_port, (Refused,), _messages),
    "launch": Reader(
        _in_file("toml", load),
        (ConfigurationError,),
        lambda: [file.read_bytes() for file in sorted((ROOT / "launch").glob("*.toml"))],
    ),
    "recording": Reader(_in_file("mcap", _recording), (ConfigurationError,), _recordings),
    "serial": Reader(
        _serial, (), lambda: [b"".join(fuzz_pioneer.stream(random.Random(seed)).pieces) for seed in range(8)]
    ),
    "ros2": Reader(_ros, (codec.MalformedError,), _ros_messages),
    "jpeg": Reader(lambda data: jpeg.decode(data, *_SIZE_PX), (jpeg.JpegError,), _image),
    "policy": Reader(lambda data: PolicyTable.from_bytes(sealed(data)), (ValueError,), _policies),
    "snapshot": Reader(_snapshot, (ValueError,), _snapshots),
    "words": Reader(_words, (COMPLAINT, ConfigurationError), lambda: _TYPED),
    "settings": Reader(_settings, (ConfigurationError,), lambda: _SET),
}
"""Name -> who reads."""
