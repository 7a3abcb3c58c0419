"""An hour of real time on the bus, and eight hours in lockstep: memory flat, no message lost, no drift of rates.

python -m benchmarks.soak [--minutes M] [--lockstep-hours H] [--keep DIRECTORY]
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from benchmarks.figure import Figure
from benchmarks.memory import Memory, growth, quarter
from benchmarks.rates import paced, rates
from benchmarks.watched import children, realm_copy
from cli.on_bus import run_on_bus
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load
from runtime.recording import Recording
from runtime.system import System

Processes = Callable[[str], Mapping[str, int]]
"""Name -> process id of others beside a running realm."""

MINUTES = 60.0
LOCKSTEP_HOURS = 8.0
_FLAT = 5.0
"""% that a process may grow from the second quarter of a run to the last."""
_STEADY = 1.0
"""% by which the rate of a topic may change between them."""
_LOOKS = 400
"""Samples of each process, about."""
_LEARNS = "pilot.train_s=1e9"
"""It trains all the time."""


def figures(minutes: float = MINUTES, lockstep_hours: float = LOCKSTEP_HOURS, keep: str = "") -> list[Figure]:
    """Both; a length of 0 leaves one out."""
    runs = (("real", minutes * 60.0), ("lockstep", lockstep_hours * 3600.0))
    return [figure for clock, duration_s in runs if duration_s for figure in soak(clock, duration_s, keep)]


def soak(clock: str, duration_s: float, keep: str = "", processes: Processes = lambda _: {}) -> list[Figure]:
    """Run `launch/sim.toml` for so much session time and judge it.

    Args:
        clock: real or lockstep.
        duration_s: session time.
        keep: directory for recording and samples; empty = they are not kept.
        processes: others to look at, asked for at each look.
    """
    with tempfile.TemporaryDirectory() as folder:
        launch = realm_copy(Path(folder), f"benchmark/soak-{Path(folder).name}")
        file = Path(keep or folder) / f"{clock}.mcap"
        return judged(load(launch, [_LEARNS], clock=clock, recording=file), duration_s, processes)


def judged(system: System, duration_s: float, processes: Processes = lambda _: {}) -> list[Figure]:
    """Run a system that is recorded; the samples are written beside the recording."""
    file, clock = system.recording, system.clock
    assert file is not None
    watch = Looker(duration_s / _LOOKS, lambda: processes(system.realm))
    began_s = time.monotonic()
    failed, reason = run_on_bus(system, watch, duration_s)
    wall_s = time.monotonic() - began_s
    watch.memory.write(file.with_suffix(".csv"))
    found = rates(Recording(file).messages(), paced(system))
    length = f"{watch.board.robot_s / 60:.1f} robot-minutes in {wall_s / 60:.1f}, ended by {reason}"
    held = f"of {found.messages}, {file.stat().st_size / 1e6:.0f} MB; {length}"
    return [
        *_memory(clock, watch.memory),
        Figure(f"{clock}: messages lost", max(found.lost, watch.lost), at_most=0, note=held),
        Figure(f"{clock}: refused or failed", watch.refused + failed, at_most=0, note=watch.refusal),
        Figure(f"{clock}: largest change of a rate", 100 * found.drift, "%", at_most=_STEADY, note=found.topic),
    ]


def _memory(clock: str, memory: Memory) -> list[Figure]:
    return [
        Figure(
            f"{clock}: private memory of {name}",
            100 * growth(samples),
            "%",
            at_most=_FLAT,
            note=f"median of each quarter: {', '.join(f'{quarter(samples, n):.1f}' for n in range(4))} MB",
        )
        for name, samples in sorted(memory.series.items())
    ]


class Looker(Watch):
    """Looks at the memory of the session's processes, this one included, again and again."""

    def __init__(self, period_s: float, others: Callable[[], Mapping[str, int]]) -> None:
        """Look once a period of session time."""
        super().__init__(Progress("soak", quiet=False))
        self.memory = Memory()
        self._period_s = period_s
        self._due_s = 0.0
        self._others = others

    def show(self) -> None:
        """Called again and again while the session runs."""
        super().show()
        if self.board.robot_s > 0.0 and self.board.robot_s >= self._due_s:
            self._due_s = self.board.robot_s + self._period_s
            pids = children(os.getpid()) | {"supervisor": os.getpid()} | dict(self._others())
            self.memory.look(pids, self.board.robot_s)


def main() -> None:
    """Print the numbers."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=0.0)
    parser.add_argument("--lockstep-hours", type=float, default=0.0)
    parser.add_argument("--keep", default="", help="directory for recordings and samples")
    options = parser.parse_args()
    for figure in figures(options.minutes, options.lockstep_hours, options.keep):
        print(f"{figure.name:36} {figure.value:10.3f} {figure.unit:4} {figure.rule:8} {figure.note}")


if __name__ == "__main__":
    main()
