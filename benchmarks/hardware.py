"""`berth check hardware` and `berth tune head` over faults of the simulated robot, and over right robots.

Each fault is looked for in the whole robot with camera images and all disturbances; then what was proposed is put in
and the check is run again. Motion is measured by the simulator's truth.

python -m benchmarks hardware
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from benchmarks.figure import Figure
from cli.correction import corrected, corrections
from cli.inspection import inspected, run_stage
from docking.angles import DEG
from runtime.launch import load
from runtime.system import System
from schemas.inspection_pb2 import Finding
from schemas.truth_pb2 import Truth

LAUNCH = "launch/sim.toml"
FAULTS = {
    "pan": ("facing", "pan=-1", {"pan motor"}),
    "pan, encoder too": ("facing", "pan=-1, pan_encoder=-1", {"pan motor", "pan encoder"}),
    "tilt": ("facing", "tilt=-1", {"tilt motor"}),
    "tilt, encoder too": ("facing", "tilt=-1, tilt_encoder=-1", {"tilt motor", "tilt encoder"}),
    "forward": ("facing", "forward=-1", {"drive"}),
    "forward, odometry too": ("facing", "forward=-1, odometry=-1", {"drive", "odometry"}),
    "turn": ("facing", "turn=-1", {"turn"}),
    "turn, heading too": ("facing", "turn=-1, heading=-1", {"turn", "heading"}),
    "encoder in degrees": ("facing", "pan_encoder=57.29578", {"pan encoder"}),
    "odometry in mm": ("facing", "odometry=1000", {"odometry"}),
    "lift": ("fingertips", "lift_reversed=true", {"lift"}),
    "gripper": ("fingertips", "fingers_reversed=true", {"fingers"}),
    "beams swapped": ("fingertips", "beams_swapped=true", {"beams' order"}),
    "inner beam inverted": ("fingertips", "inner_beam_inverted=true", {"inner beam"}),
    "outer beam inverted": ("fingertips", "outer_beam_inverted=true", {"outer beam"}),
    "camera 100 ms late": ("head", "camera_latency_s=0.1", {"camera latency"}),
    "encoders 100 ms late": ("head", "encoder_latency_s=0.1", {"encoder latency"}),
}
"""Name -> stage, `simulator.wiring`, what must be found and nothing else."""
STAGES = ("facing", "fingertips", "head")
RIGHT_SEEDS, FAULT_SEEDS = range(1, 21), range(101, 102)
FOCAL_PX = 364.0
_WITHIN_S, _WITHIN_M, _WITHIN_DEG = 60.0, 0.05, 10.0


class Outcome(NamedTuple):
    """One stage."""

    system: System
    reason: str
    robot_s: float
    findings: list[Finding]
    moved_m: float
    turned_deg: float

    @property
    def wrong(self) -> set[str]:
        """What is not right."""
        return {finding.thing for finding in self.findings if finding.verdict != Finding.GOOD}

    def measured(self, thing: str) -> float:
        """Its number."""
        return next((finding.measured for finding in self.findings if finding.thing == thing), math.nan)


def figures() -> list[Figure]:
    """Faults found and put right, time, motion, errors, false alarms."""
    robots = {seed: {stage: _run(_robot("", seed), stage) for stage in STAGES} for seed in RIGHT_SEEDS}
    faulty = {name: [_found(*fault[:2], seed) for seed in FAULT_SEEDS] for name, fault in FAULTS.items()}
    right = [outcome for stages in robots.values() for outcome in stages.values()]
    pairs = [pair for found in faulty.values() for pair in found]
    alarms = sum(bool(outcome.wrong) or outcome.reason != "finished" for outcome in right)
    note = f"{len(RIGHT_SEEDS)} seeds, {len(STAGES)} stages"
    found = [_fault(name, outcomes) for name, outcomes in faulty.items()]
    again = sum(bool(after.wrong) or after.reason != "finished" for _, after in pairs)
    return [
        *found,
        Figure("checks after the correction that do not pass", again, at_most=0, note=f"of {len(pairs)}"),
        Figure("false alarms on right robots", alarms, at_most=0, note=note),
        *_tuned([stages["head"] for stages in robots.values()], "right"),
        *_extents([*right, *(before for before, _ in pairs)]),
        _whole(robots.values()),
    ]


def _fault(name: str, outcomes: list[tuple[Outcome, Outcome]]) -> Figure:
    expected = FAULTS[name][2]
    hits = sum(before.wrong == expected for before, _ in outcomes)
    return Figure(f"{name}: found, and nothing else", hits / len(outcomes), at_least=1.0, note="share of the robots")


def _whole(robots: Iterable[dict[str, Outcome]]) -> Figure:
    """Both stages of one check."""
    slowest_s = max(stages["facing"].robot_s + stages["fingertips"].robot_s for stages in robots)
    return Figure("check hardware, both stages, longest", slowest_s, "s", at_most=_WITHIN_S)


def _extents(outcomes: list[Outcome]) -> list[Figure]:
    return [
        Figure("one stage, longest", max(o.robot_s for o in outcomes), "s", at_most=_WITHIN_S),
        Figure("robot moved, most", 100 * max(o.moved_m for o in outcomes), "cm", at_most=100 * _WITHIN_M),
        Figure("robot, pan or tilt turned, most", max(o.turned_deg for o in outcomes), "deg", at_most=_WITHIN_DEG),
    ]


def _tuned(outcomes: list[Outcome], name: str) -> list[Figure]:
    """Errors of the latencies over all pairs of latencies, and of pixels per degree."""
    late = [(0.1, 0.0), (0.0, 0.1), (0.06, 0.12), (0.22, 0.03)]
    robots = [(c, e, _run(_robot(_late(c, e), 201 + i), "head")) for i, (c, e) in enumerate(late)]
    robots += [(0.0, 0.0, outcome) for outcome in outcomes]
    camera_s = max(abs(o.measured("camera latency") - c) for c, _, o in robots)
    encoder_s = max(abs(o.measured("encoder latency") - e) for _, e, o in robots)
    focal = max(abs(o.measured("pixels per degree") / (FOCAL_PX * DEG) - 1.0) for _, _, o in robots)
    note = f"{len(outcomes)} {name} robots and {len(late)} that lag by 30 to 220 ms"
    return [
        Figure("camera latency, largest error", 1e3 * camera_s, "ms", at_most=10, note=note),
        Figure("encoder latency, largest error", 1e3 * encoder_s, "ms", at_most=10, note=note),
        Figure("pixels per degree, largest error", 100 * focal, "%", at_most=2, note=note),
    ]


def _late(camera_s: float, encoder_s: float) -> str:
    return f"camera_latency_s={camera_s}, encoder_latency_s={encoder_s}"


def _robot(wiring: str, seed: int) -> System:
    return load(LAUNCH, [f"simulator.wiring={{{wiring}}}"], clock="lockstep", seed=seed)


def _found(stage: str, wiring: str, seed: int) -> tuple[Outcome, Outcome]:
    """(as it is, with the corrections)."""
    before = _run(_robot(wiring, seed), stage)
    return before, _run(corrected(before.system, corrections(before.system, before.findings)), stage)


def _run(system: System, stage: str) -> Outcome:
    truths: list[Truth] = []
    watch = {system.truth: lambda truth, _: truths.append(truth)}
    result = run_stage(inspected(system, stage), in_process=True, watch=watch)
    first = truths[0]
    moved_m = max(math.hypot(truth.x_m - first.x_m, truth.y_m - first.y_m) for truth in truths)
    turned_rad = max(max(_turns(first, truth)) for truth in truths)
    return Outcome(system, result.reason, result.robot_s, result.findings, moved_m, turned_rad / DEG)


def _turns(first: Truth, truth: Truth) -> tuple[float, float, float]:
    return (
        abs(truth.heading_rad - first.heading_rad),
        abs(truth.pan_rad - first.pan_rad),
        abs(truth.tilt_rad - first.tilt_rad),
    )
