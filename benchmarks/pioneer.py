"""The learned policy through a Pioneer's serial protocol beside the direct simulation, from the same starts.

The emulated robot of the tests stands between base and the simulated wheels and gripper, in lockstep.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
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
_DIRECT, _SERIAL = "components.simulator", "tests.pioneer.serial_world"


def figures() -> list[Figure]:
    """Train directly, then evaluate the frozen policy both ways."""
    settings = (f"pilot.policy={learned_policy(TRAIN_S)}",)
    return compared(evaluate(settings, 0, STARTS), {"through the line": evaluate_serially(settings, 0, STARTS)})


def evaluate_serially(overrides: Sequence[str], first: int, count: int) -> list[Trial]:
    """As `evaluate`, with the emulated robot and its line in between."""
    return evaluate_in(_SERIAL, (*LATE, *overrides), first, count)


def evaluate_in(world: str, overrides: Sequence[str], first: int, count: int) -> list[Trial]:
    """As `evaluate`, in another world than the simulator's: a component with the same ports."""
    with tempfile.TemporaryDirectory() as folder:
        launch = Path(folder) / "world.toml"
        launch.write_text(LAUNCH.read_text(encoding="utf-8").replace(f'"{_DIRECT}"', f'"{world}"'), encoding="utf-8")
        return evaluate(overrides, first, count, launch)


def compared(direct: Sequence[Trial], others: Mapping[str, Sequence[Trial]]) -> list[Figure]:
    """What became of the same starts, directly and otherwise; and which share of it is kept."""
    found = [
        Figure(f"{name}: {word}", sum(getattr(trial, word) for trial in trials), note=f"of {len(trials)}")
        for name, trials in {"directly": direct, **others}.items()
        for word in ("docked", "picked", "collided")
    ]
    return [*found, *(_share(word, direct, name, own) for name, own in others.items() for word in ("docked", "picked"))]


def _share(word: str, direct: Sequence[Trial], name: str, trials: Sequence[Trial]) -> Figure:
    of, ours = (sum(getattr(trial, word) for trial in those) for those in (direct, trials))
    return Figure(f"{word} {name}, of directly", 100 * ours / max(of, 1), "%", at_least=95)
