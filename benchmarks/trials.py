"""Evaluation trials with the camera in the loop, in as many processes as there are cores."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

from joblib import Parallel, delayed

from docking.score import Scorer, Trial
from report.frames import Scoreboard
from runtime.launch import load
from runtime.lockstep import Lockstep

LAUNCH = Path("launch/sim.toml")


def evaluate(overrides: Sequence[str], first: int, count: int, launch: Path = LAUNCH) -> list[Trial]:
    """Trials from `count` consecutive starts of the simulator's list.

    Args:
        overrides: as on the command line; they choose the controller.
        first: number of the first start.
        count: how many.
        launch: file of the system.
    """
    chunk = max(1, -(-count // (4 * (os.cpu_count() or 1))))
    jobs = [
        delayed(_part)(tuple(overrides), start, min(chunk, first + count - start), launch)
        for start in range(first, first + count, chunk)
    ]
    parts: Iterable[list[Trial]] = Parallel(n_jobs=-1)(jobs)
    return [trial for part in parts for trial in part]


def _part(overrides: tuple[str, ...], first: int, count: int, launch: Path) -> list[Trial]:
    """One process's share; nothing is learned and nothing recorded."""
    fixed = ["pilot.train_s=0", f"pilot.evaluation_trials={count}", f"pilot.first_start={first}"]
    system = load(
        launch, [*fixed, *overrides], only=("simulator", "vision", "head", "tracker", "pilot", "grasper", "base")
    )
    return watched(Lockstep(system)).trials


def watched(engine: Lockstep, duration_s: float | None = None) -> Scorer:
    """Run a session to its end; its trials, judged."""
    board = Scoreboard()
    for key in ("pilot/trial", "simulator/truth"):
        engine.watch(key, board.take)
    engine.run(duration_s)
    return board.scorer


def policy_file(policy: bytes) -> str:
    """Path of a temporary file that holds a policy; removed with the machine's temporary files."""
    with tempfile.NamedTemporaryFile(suffix=".policy", delete=False) as file:
        file.write(policy)
    return file.name
