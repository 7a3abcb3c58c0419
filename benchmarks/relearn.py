"""Learning again from 40 robot-minutes, against reading the same channels with the mcap library."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from mcap.reader import make_reader

from benchmarks.figure import Figure
from cli.in_process import run_in_process
from cli.lessons import learn
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load

LAUNCH = Path("launch/sim.toml")
MINUTES = 40.0
COMPONENT = "learner"
REPEATS = 3
Result = TypeVar("Result")


def figures() -> list[Figure]:
    """The session is made in this process, with camera images in it."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "session.mcap"
        overrides = (f"pilot.train_s={60 * MINUTES}", "pilot.evaluation_trials=0")
        system = load(LAUNCH, overrides, recording=file)
        run_in_process(system, Watch(Progress("", quiet=True)), "", None)
        topics = list(system.component(COMPONENT).inputs.values())
        learn([file], COMPONENT, (), compare=True)  # compiling is start-up
        floor_s, _ = _best(lambda: _read(file, topics))
        learned_s, lessons = _best(lambda: learn([file], COMPONENT, (), compare=False))
        compared_s, _ = _best(lambda: learn([file], COMPONENT, (), compare=True))
    same = 1.0 if lessons.same else 0.0
    return [
        Figure("the mcap library reads percepts, trials, commands", floor_s, "s", note="processor time: the floor"),
        Figure("relearn", learned_s / floor_s, "x floor", at_most=1.5, note=f"{learned_s:.2f} s, without images"),
        Figure("relearn with predictions", compared_s / floor_s, "x floor", note=f"{compared_s:.2f} s"),
        Figure("same tables as live", same, at_least=1.0, note=lessons.checks[0].words),
    ]


def _read(file: Path, topics: list[str]) -> int:
    with file.open("rb") as stream:
        return sum(1 for _ in make_reader(stream).iter_messages(topics, log_time_order=False))


def _best(work: Callable[[], Result]) -> tuple[float, Result]:
    """Least processor time of a few repetitions, and the last result."""
    times = []
    for _ in range(REPEATS):
        began_s = time.process_time()
        result = work()
        times.append(time.process_time() - began_s)
    return min(times), result
