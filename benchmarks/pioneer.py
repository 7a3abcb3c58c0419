"""The learned policy through a Pioneer's serial protocol beside the direct simulation, from the same starts.

The emulated robot of the tests stands between base and the simulated wheels and gripper, in lockstep.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

from benchmarks.evaluation import TRAIN_S, learned_policy
from benchmarks.figure import Figure
from benchmarks.trials import LAUNCH, evaluate
from docking.score import Trial

STARTS = 200
LATE = (
    "simulator.wiring={camera_latency_s=0.05,encoder_latency_s=0.05}",
    "tracker.camera_latency_s=0.05",
    "tracker.encoder_latency_s=0.05",
)
"""Where the camera looked is known 0.05 s later, most of the time, and pictures wait for it."""
_DIRECT, _SERIAL = '"components.simulator"', '"tests.pioneer.serial_world"'


def figures() -> list[Figure]:
    """Train directly, then evaluate the frozen policy both ways."""
    settings = (f"pilot.policy={learned_policy(TRAIN_S)}",)
    direct, serial = evaluate(settings, 0, STARTS), evaluate_serially(settings, 0, STARTS)
    found = [
        Figure(f"{name}: {word}", sum(getattr(trial, word) for trial in trials), note=f"of {STARTS}")
        for name, trials in (("directly", direct), ("through the line", serial))
        for word in ("docked", "picked", "collided")
    ]
    return [*found, *(_share(word, direct, serial) for word in ("docked", "picked"))]


def evaluate_serially(overrides: Sequence[str], first: int, count: int) -> list[Trial]:
    """As `evaluate`, with the emulated robot and its line in between."""
    with tempfile.TemporaryDirectory() as folder:
        launch = Path(folder) / "serial.toml"
        launch.write_text(LAUNCH.read_text(encoding="utf-8").replace(_DIRECT, _SERIAL), encoding="utf-8")
        return evaluate((*LATE, *overrides), first, count, launch)


def _share(word: str, direct: Sequence[Trial], serial: Sequence[Trial]) -> Figure:
    of, ours = (sum(getattr(trial, word) for trial in trials) for trials in (direct, serial))
    return Figure(f"{word} through the line, of directly", 100 * ours / max(of, 1), "%", at_least=95)
