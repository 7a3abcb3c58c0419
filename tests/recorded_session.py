"""Whole sessions in one process each, recorded, for the tests."""

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from cli.in_process import run_in_process
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load
from runtime.system import System

ROOT = Path(__file__).parent.parent
LAUNCH = ROOT / "launch" / "sim.toml"
TRAIN_S = 100
LEARNING = (f"pilot.train_s={TRAIN_S}", "pilot.evaluation_trials=1", "pilot.evaluation_controller=lc")
"""Learns for a while, then docks once by the linear law from a demo start and picks up."""


def record(file: Path, overrides: Sequence[str] = (), *, seed: int = 1, started: str = "", duration_s=None) -> System:
    """Run a session of `launch/sim.toml` in this process."""
    system = load(LAUNCH, overrides, seed=seed, recording=file)
    run_in_process(system, Watch(Progress("", quiet=True)), started, duration_s)
    return system


class Twins(NamedTuple):
    """Recordings of one seed under two hash seeds and two starting times, and of another seed."""

    first: Path
    second: Path
    stranger: Path


def make_twins(directory: Path) -> Twins:
    """All three at once, each in a process of its own."""
    files = Twins(*(directory / f"{name}.mcap" for name in Twins._fields))
    jobs = [(files.first, "1", "1", ""), (files.second, "4242", "1", ""), (files.stranger, "1", "2", "5")]
    processes = [
        subprocess.Popen(
            [sys.executable, "-m", "tests.recorded_session", file, seed, f"started for {file.stem}", duration],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": hash_seed},
        )
        for file, hash_seed, seed, duration in jobs
    ]
    assert [process.wait(timeout=300) for process in processes] == [0, 0, 0]
    return files


def main() -> None:
    """Record one of the twins."""
    file, seed, started, duration = sys.argv[1:]
    record(Path(file), LEARNING, seed=int(seed), started=started, duration_s=float(duration) if duration else None)


if __name__ == "__main__":
    main()
