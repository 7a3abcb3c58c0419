"""The inspector in a whole simulated robot, in one process: what it found, and how far it moved the robot."""

import math
from typing import NamedTuple

from cli.correction import corrected, corrections
from cli.inspection import Result, inspected, run_stage
from runtime.launch import load
from runtime.system import System
from schemas.inspection_pb2 import Finding
from tests.recorded_session import LAUNCH


class Inspection(NamedTuple):
    """One stage."""

    system: System
    result: Result
    moved_m: float
    turned_deg: float
    """Largest of robot, pan and tilt, from where they stood."""

    @property
    def wrong(self) -> set[str]:
        """What is not right."""
        return {finding.thing for finding in self.result.findings if finding.verdict != Finding.GOOD}

    @property
    def measured(self) -> dict[str, float]:
        return {finding.thing: finding.measured for finding in self.result.findings}

    @property
    def right(self) -> System:
        """The system with the corrections."""
        return corrected(self.system, corrections(self.system, self.result.findings))


def robot(wiring: str = "", seed: int = 1, *more: str) -> System:
    overrides = [f"simulator.wiring={{{wiring}}}", *more]
    return load(LAUNCH, overrides, clock="lockstep", seed=seed)


def inspect(system: System, stage: str) -> Inspection:
    truths = []
    result = run_stage(
        inspected(system, stage), in_process=True, watch={"simulator/truth": lambda truth, _: truths.append(truth)}
    )
    first = truths[0]
    moved_m = max(math.hypot(t.x_m - first.x_m, t.y_m - first.y_m) for t in truths)
    turned = max(
        abs(getattr(t, name) - getattr(first, name)) for t in truths for name in ("heading_rad", "pan_rad", "tilt_rad")
    )
    assert abs(truths[-1].v_mps) + abs(truths[-1].omega_radps) == 0.0, "the robot rests at the end"
    return Inspection(system, result, moved_m, math.degrees(turned))
