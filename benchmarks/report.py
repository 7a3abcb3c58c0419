"""The report about a session of 40 robot-minutes: how long it takes, against reading the file alone."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.figure import Figure
from cli.in_process import run_in_process
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load
from runtime.recording import Recording

LAUNCH = Path("launch/sim.toml")
MINUTES = 40.0
TRIALS = 30
"""Of the evaluation; they come after the 40 minutes."""
REPEATS = 3


def figures() -> list[Figure]:
    """The session is made in this process, camera images included; the page by the command, started anew each time."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "session.mcap"
        overrides = (f"pilot.train_s={60 * MINUTES}", f"pilot.evaluation_trials={TRIALS}")
        run_in_process(load(LAUNCH, overrides, recording=file), Watch(Progress("", quiet=True)), "", None)
        _made_s([file])  # compiling is done once
        read_s = min(_read_s(file) for _ in range(REPEATS))
        page_s = min(_made_s([file]) for _ in range(REPEATS))
        page_kb = file.with_suffix(".html").stat().st_size / 1e3
        both_s = min(_made_s([file, file]) for _ in range(REPEATS))
        size_bytes = file.stat().st_size
        note = f"{size_bytes / 1e6:.0f} MB, {Recording(file).session()['clock']}; wall time of the command"
        return [
            Figure("reading every message", read_s, "s", note="in this process: the floor"),
            Figure("berth report", page_s, "s", at_most=5.0, note=note),
            Figure("berth report A B", both_s, "s", note="the same session twice"),
            Figure("size of the page", page_kb, "kB"),
        ]


def _read_s(file: Path) -> float:
    began_s = time.monotonic()
    for _ in Recording(file).messages():
        pass
    return time.monotonic() - began_s


def _made_s(files: list[Path]) -> float:
    output = files[0].with_suffix(".html")
    began_s = time.monotonic()
    words = [sys.executable, "-m", "cli.main", "report", *map(str, files), "-o", str(output), "--json"]
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    assert json.loads(done.stdout)["report"] == str(output)
    return time.monotonic() - began_s
