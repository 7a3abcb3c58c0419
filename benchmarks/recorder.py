"""What the recorder costs, what it loses, and what a `kill -9` costs.

python -m benchmarks.recorder [SECONDS]
"""

from __future__ import annotations

import os
import random
import signal
import sys
import tempfile
import time
from collections import deque
from pathlib import Path
from typing import NamedTuple

from benchmarks.bus import cpu_s, ring
from benchmarks.figure import Figure
from runtime.launch import load
from runtime.log import LogWriter
from runtime.recording import Recording
from runtime.supervise import Supervisor
from runtime.system import System

SECONDS = 60.0
KILLS = 20
_READY_S, _DEAD_S = 60.0, 10.0


def figures(seconds: float = SECONDS) -> list[Figure]:
    """A minute of a fast camera and 500 small messages a second; then the kills."""
    with tempfile.TemporaryDirectory() as name:
        flood = _flood(Path(name), seconds)
        kills = [_kill(Path(name), number, lockstep=number % 2 == 1) for number in range(KILLS)]
    load_words = f"30 Hz of 40 kB and 500 small messages/s for {seconds:g} s"
    worst = max(kills, key=lambda kill: kill.lost_s)
    return [
        Figure("messages lost by the recorder", flood.lost, at_most=0, note=f"{load_words}: {flood.messages} messages"),
        Figure(
            "processor time of the recorder",
            100 * flood.cpu,
            "% of a core",
            at_most=25,
            note=f"writing the same messages without a bus: {100 * flood.floor:.1f} %",
        ),
        Figure("kill -9, real time: most lost", max(k.lost_s for k in kills[0::2]), "s", at_most=1.0),
        Figure("kill -9, lockstep at full speed: most lost", max(k.lost_s for k in kills[1::2]), "s", at_most=1.0),
        Figure("files readable after kill -9", sum(k.readable for k in kills), f"of {KILLS}", at_least=KILLS),
        Figure("messages missing inside them", sum(k.holes for k in kills), at_most=0, note=f"worst: {worst}"),
    ]


class Flooded(NamedTuple):
    """A finished recording."""

    messages: int
    lost: int
    cpu: float
    """Processor seconds per second."""
    floor: float


def _flood(directory: Path, seconds: float) -> Flooded:
    system = _flooded(directory, "flood", seconds)
    with Supervisor(system) as supervisor:
        _await_ready(supervisor)
        before_s, began_s = cpu_s(supervisor.pids["recorder"]), time.monotonic()
        used_s = 0.0
        while supervisor.poll(0.1):
            used_s, wall_s = cpu_s(supervisor.pids["recorder"]) - before_s, time.monotonic() - began_s
        supervisor.stop()
    file = _recording(system)
    rows = Recording(file).topics()
    sent = sum(row.count + row.lost for row in rows)
    messages = sum(row.count for row in rows)
    expected = sum(status.published for status in supervisor.statuses.values())
    lost = max(sent - messages, expected - sum(row.count for row in rows if "/status" not in row.topic))
    return Flooded(messages, max(lost, supervisor.lost), used_s / wall_s, _writing_s(file) / seconds)


def _writing_s(file: Path) -> float:
    """Processor seconds to write a recording's messages once more, flushed as often."""
    copy = file.with_suffix(".copy.mcap")
    messages = list(Recording(file).messages())
    system = _flooded(file.parent, "copy", 1.0)
    began_s = time.process_time()
    log = LogWriter(copy, system, started="")
    flush_ns = 0
    for logged in messages:
        log.write(*logged)
        if logged.time_ns > flush_ns:
            log.flush()
            flush_ns = logged.time_ns + 500_000_000
    log.close()
    used_s = time.process_time() - began_s
    copy.unlink()
    return used_s


def _flooded(directory: Path, name: str, seconds: float) -> System:
    file = directory / f"{name}.toml"
    file.write_text(
        f"""
realm = "benchmark/{directory.name}-{name}"
[session]
clock = "real"
end = "flood/end"
[component.flood]
run = "benchmarks.ring.flood"
params = {{ duration_s = {seconds} }}
[component.recorder]
run = "components.recorder"
""",
        encoding="utf-8",
    )
    return load(file, recording=directory / f"{name}.mcap")


def _await_ready(supervisor: Supervisor) -> None:
    deadline_s = time.monotonic() + _READY_S
    while supervisor.missing and supervisor.poll(0.01):
        assert time.monotonic() < deadline_s, supervisor.missing


class Killed(NamedTuple):
    """What was left of one recording."""

    after_s: float
    """Wall time from ready to the kill."""
    lost_s: float
    """Wall time before the kill of which nothing is in the file."""
    readable: bool
    holes: int
    """Messages missing before the newest one of their key."""


def _kill(directory: Path, number: int, *, lockstep: bool) -> Killed:
    """Kill the recorder at a random moment, and see up to where its file reaches."""
    folder = directory / f"kill{number}"
    folder.mkdir()
    system = ring(folder, 1_000_000) if lockstep else _flooded(folder, "kill", 3600.0)
    key = "simulator/base" if lockstep else "flood/small"
    seen: deque[tuple[float, int]] = deque(maxlen=1_000_000)
    after_s = random.Random(number).uniform(0.2, 2.0)
    supervisor = Supervisor(system)
    supervisor.watch(key, lambda _, capture_ns: seen.append((time.monotonic(), capture_ns)))
    with supervisor:
        _await_ready(supervisor)
        until_s = time.monotonic() + after_s
        while time.monotonic() < until_s and supervisor.poll(0.01):
            pass
        os.kill(supervisor.pids["recorder"], signal.SIGKILL)
        killed_s = time.monotonic()
        while supervisor.poll(0.01) and time.monotonic() < killed_s + _DEAD_S:
            pass
    recording = Recording(_recording(system))
    newest_ns = max((logged.capture_ns for logged in recording.messages([key])), default=-1)
    missing = [moment_s for moment_s, capture_ns in seen if capture_ns > newest_ns and moment_s <= killed_s]
    lost_s = killed_s - missing[0] if missing else 0.0
    return Killed(after_s, lost_s, newest_ns >= 0 or after_s < 1.0, sum(row.lost for row in recording.topics()))


def _recording(system: System) -> Path:
    assert system.recording is not None
    return system.recording


def main() -> None:
    """Print the numbers."""
    for figure in figures(*map(float, sys.argv[1:2])):
        print(f"{figure.name:44} {figure.value:10.3f} {figure.unit:12} {figure.rule:10} {figure.note}")


if __name__ == "__main__":
    main()
