"""A robot driven from a laptop while everything happens to the laptop and to the air between them.

`launch/sim2.toml` on two machines, 2 Mbit/s between them, the laptop's clocks ten seconds ahead. The laptop drives; its
supervisor, and the router in it, is killed and started again; the air turns bad; the link is cut for three seconds.
What happened is read from the robot's own recording, by the robot's clock, and from the laptop's.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.circling.component import SPEED_MPS
from benchmarks.halves import LAUNCH, Echo, Halves, awaits_run_file, echoed, rejoin, start
from benchmarks.machines import Cable, Machine
from benchmarks.watched import wait_until
from benchmarks.wire import Quality
from runtime.recording import Logged, Recording

BAD = Quality(loss=0.05, jitter_s=0.05)
RATE_BPS = 2_000_000
AHEAD_S = 10.0
CUT_S = 3.0
PATIENCE_S = 300.0
"""A machine may be busy."""
_DRIVEN_FRAMES = 16
_BEGUN_BYTES = 50_000
"""Of a recording that holds more than its head."""
_STALE_NS = 1_000_000_000
"""What waited for the link is older; what a busy recorder took late is not."""
_CIRCLING = """
[component.circling]
run = "benchmarks.circling"
host = "laptop"
inputs = { base = "base/state" }
"""


class Interruption(NamedTuple):
    """Session times of the robot."""

    cut_ns: int
    """The laptop was killed, or the link cut."""
    mended_ns: int
    """It was started again, or the link put in."""


class Story(NamedTuple):
    """What is left of it."""

    robot: Recording
    laptop: Recording
    """From its second start."""
    killed: Interruption
    cut: Interruption
    summaries: list[dict[str, Any]]

    def moves(self) -> list[Logged]:
        """Commands of base that move the robot, in order."""
        return [m for m in self.robot.messages({"base/applied"}) if is_motion(m)]

    def stop_s(self, interruption: Interruption) -> float:
        """From the interruption to base's first command to rest, by base's own clock."""
        applied = [m for m in self.robot.messages({"base/applied"}) if m.capture_ns < interruption.mended_ns]
        last = max(i for i, m in enumerate(applied) if is_motion(m))
        return (applied[last + 1].capture_ns - interruption.cut_ns) / 1e9

    def back_s(self, interruption: Interruption) -> float:
        """From the mending to the first frame in which the laptop moves the robot again."""
        return min(m.capture_ns - interruption.mended_ns for m in self.moves_after(interruption)) / 1e9

    def moves_after(self, interruption: Interruption) -> list[Logged]:
        """Motion for frames after the mending."""
        return [m for m in self.moves() if m.capture_ns >= interruption.mended_ns]

    def moves_by_old_commands(self, interruption: Interruption) -> int:
        """Motion for frames of before the interruption, a second and more after it."""
        late_ns = interruption.cut_ns + _STALE_NS
        return sum(m.time_ns > late_ns and m.capture_ns < interruption.mended_ns for m in self.moves())

    def old_commands(self, interruption: Interruption) -> int:
        """Commands of the laptop that came after the mending and answer frames of before the interruption."""
        heard = self.robot.messages({"circling/drive"})
        return sum(m.time_ns > interruption.mended_ns > m.capture_ns + _STALE_NS for m in heard)


def is_motion(message: Logged) -> bool:
    """Whether a `base/applied` moves the robot."""
    command = message.decoded()
    return bool(command.v_mps != 0.0 or command.omega_radps != 0.0)


def told(cable: Cable, directory: Path) -> Story:
    """Live through it.

    Args:
        cable: a radio.
        directory: for launch file and recordings.
    """
    cable.narrow(RATE_BPS)
    cable.laptop.ahead_s = AHEAD_S
    launch = LAUNCH.replace('device = "simulator/base" }', 'device = "simulator/base", teleop = "circling/drive" }')
    halves = start(cable, directory, launch=launch + _CIRCLING)
    awaits_run_file(cable.robot)
    recorder = cable.robot.berth("record", "-o", str(directory / "robot.mcap"), "--json")
    with echoed(cable.robot, "base/applied", directory / "applied.jsonl") as applied:
        drives(applied, halves, PATIENCE_S)
        happens(lambda: (directory / "robot.mcap").stat().st_size > _BEGUN_BYTES, recorder.poll, PATIENCE_S)
        killed, halves = _kill(cable, directory, halves, applied)
        cable.become(BAD)
        drives(applied, halves, PATIENCE_S)
        cut = _cut(cable, halves, applied)
        halves.interrupt()
        summaries = halves.summaries()
        recorded = recorder.communicate(timeout=60)  # it ends with the session
        assert json.loads(recorded[0] or "{}").get("exit_reason") == "the system has ended", recorded
    return Story(Recording(directory / "robot.mcap"), Recording(directory / "again.mcap"), killed, cut, summaries)


def _kill(cable: Cable, directory: Path, halves: Halves, applied: Echo) -> tuple[Interruption, Halves]:
    """Kill the laptop's supervisor hard, and start it again once the robot rests."""
    cut_ns = session_ns(cable.robot)
    halves.laptop.kill()
    halves.laptop.communicate()
    happens(lambda: applied.last().get("v_mps") == 0.0, halves.robot.poll, 30.0)
    happens(lambda: f"{cable.laptop.host} is away" in " ".join(cable.robot.words()), halves.robot.poll, 30.0)
    mended_ns = session_ns(cable.robot)
    halves = rejoin(cable, directory, halves, directory / "again.mcap")
    drives(applied, halves, PATIENCE_S)
    return Interruption(cut_ns, mended_ns), halves


def _cut(cable: Cable, halves: Halves, applied: Echo) -> Interruption:
    """Cut the link while the robot moves, and mend it."""
    cut_ns = session_ns(cable.robot)
    cable.cut()
    happens(lambda: session_ns(cable.robot) >= cut_ns + CUT_S * 1e9, halves.robot.poll, 60.0)
    mended_ns = session_ns(cable.robot)
    cable.mend()
    drives(applied, halves, PATIENCE_S)
    return Interruption(cut_ns, mended_ns)


def drives(applied: Echo, halves: Halves, seconds: float) -> None:
    """Wait until the laptop has moved the robot for two seconds from now on."""
    frames: set[int] = set()
    since = applied.last()["frame"]

    def enough() -> bool:
        last = applied.last()
        if last["frame"] > since and last["commander"] == "teleop" and last["v_mps"] == SPEED_MPS:
            frames.add(last["frame"])
        return len(frames) >= _DRIVEN_FRAMES

    happens(enough, lambda: None if halves.alive() else 1, seconds)


def happens(condition: Callable[[], object], ended: Callable[[], int | None], seconds: float) -> None:
    """Wait for it while the session runs."""
    wait_until(lambda: condition() or ended() is not None, seconds)
    assert condition(), "it did not happen in time, or the session has ended"


def session_ns(robot: Machine) -> int:
    """Session time of the robot, now."""
    (file,) = robot.home.glob("berth/logs/*/session.json")
    return time.monotonic_ns() - int(json.loads(file.read_text(encoding="utf-8"))["origin_ns"])
