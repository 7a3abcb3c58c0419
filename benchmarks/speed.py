"""Speed of the whole system, rendering, vision, learning and recording included, against real time."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from benchmarks.figure import Figure
from cli.in_process import run_in_process
from cli.on_bus import run_on_bus
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load

LAUNCH = Path("launch/sim.toml")
ROBOT_S = 300.0
"""Long enough that start-up and numba's first calls weigh little; short enough for an afternoon."""


def figures() -> list[Figure]:
    """Both shells, with recorder."""
    with tempfile.TemporaryDirectory() as folder:
        inside = _in_process(Path(folder))
        bus, lost = _on_bus(Path(folder))
    return [
        Figure("in-process lockstep", inside, "x real time", at_least=40),
        Figure("bus lockstep, all processes", bus, "x real time", at_least=20),
        Figure("messages lost on the bus", lost, at_most=0),
    ]


def _in_process(folder: Path) -> float:
    """Speed of the second half of the session: imports and compilation are start-up."""
    system = load(LAUNCH, recording=folder / "inside.mcap")
    watch = _Stopwatch()
    run_in_process(system, watch, "", ROBOT_S)
    return watch.speed()


def _on_bus(folder: Path) -> tuple[float, int]:
    system = load(LAUNCH, recording=folder / "bus.mcap")
    watch = _Stopwatch()
    failed, reason = run_on_bus(system, watch, ROBOT_S)
    assert not failed, reason
    return watch.speed(), watch.lost


class _Stopwatch(Watch):
    """Measures robot time against wall time from the first fifth of the session on."""

    def __init__(self) -> None:
        super().__init__(Progress("", quiet=True))
        self._marks: list[tuple[float, float]] = []

    def show(self) -> None:
        """Called again and again while the session runs."""
        super().show()
        self._marks.append((time.monotonic(), self.board.robot_s))

    def speed(self) -> float:
        """Robot seconds per wall second."""
        first = next(mark for mark in self._marks if mark[1] >= 0.2 * ROBOT_S)
        last = self._marks[-1]
        return (last[1] - first[1]) / (last[0] - first[0])
