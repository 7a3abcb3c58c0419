"""A live session of all processes at real time, replayed component by component: what is the same, and how fast."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from benchmarks.figure import Figure
from cli.on_bus import run_on_bus
from cli.progress import Progress
from cli.session import Watch
from runtime.launch import load
from runtime.one_thread import limit_threads
from runtime.recording import Recording
from runtime.replay import replay

LAUNCH = Path("launch/sim.toml")
SESSION_S = 300.0


def figures() -> list[Figure]:
    """Takes as long as the session, and half a minute."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "live.mcap"
        system = load(LAUNCH, clock="real", recording=file)
        failed, reason = run_on_bus(system, Watch(Progress("", quiet=True)), SESSION_S)
        assert not failed, reason
        limit_threads()
        names = [spec.name for spec in system.components if not spec.tap]
        return [figure for name in names for figure in _figures(Recording(file), name)]


def _figures(recording: Recording, name: str) -> list[Figure]:
    began_s = time.monotonic()
    report = replay(recording, name)
    wall_s = time.monotonic() - began_s
    said = sum(report.outputs.values())
    words = "; ".join(filter(None, [outcome.words for outcome in report.runs])) or f"{said} outputs, to the end"
    return [
        Figure(f"{name}: identical", 100.0 * report.count("identical") / max(said, 1), "%", at_least=100, note=words),
        Figure(f"{name}: replayed", SESSION_S / wall_s, "x real time", note=f"{wall_s:.1f} s"),
    ]
