"""How well the head follows and the percept reads, the whole loop from camera images, without the bus.

The robot drives at 0.1 m/s and turns to and fro at 10 deg/s at random times. The floor is the paper's PD control alone,
beside it the same with feed-forward, over the same starts and the same turns; then beta as read from the slope as it
stands in the image, without taking it to the image centre.

python -m benchmarks.tracking [--json]
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Iterator
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.figure import Figure
from components.head.component import Head
from components.simulator.component import Simulator
from components.tracker.component import Tracker
from components.vision.component import Vision
from docking.angles import DEG
from runtime.contract import TICK, Event, Output
from schemas.drive_pb2 import Applied, BaseCommand
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth

SETTINGS: dict[str, dict[str, bool]] = {
    "pd": {"feed_forward": False},
    "ff": {"feed_forward": True},
    "image": {"feed_forward": True, "slope_at_centre": False},
}
"""Parameters of the tracker: PD alone, with feed-forward (the default), slope as it stands in the image."""
SPEED_MPS, TURN_RADPS = 0.1, 10 * DEG
SWITCH = 0.1
"""Chance per frame that the turn changes its side: every 1.25 s on average."""
WIDEST_RAD, NEAREST_M, LONGEST = 60 * DEG, 0.35, 240
"""Beyond this bearing the robot turns back; this near, or after this many frames, the next drive begins."""
WARM_FRAMES = 8
"""Not counted at the beginning of a drive: the robot speeds up, the filters fill."""


class Frame(NamedTuple):
    """What one frame brought."""

    truth: Truth
    percept: Percept
    tracker_us: float


class Loop:
    """Simulator, vision, head and tracker, wired by hand in the order of the bus."""

    def __init__(self, seed: int, **tracker: Any) -> None:
        self.simulator = Simulator(Simulator.Params(), seed)
        self.vision = Vision(Vision.Params(), seed)
        self.head = Head(Head.Params(), seed)
        self.tracker = Tracker(Tracker.Params(**tracker), seed)
        self.pending = self.simulator.handle(Event(0, TICK))

    def frame(self, drive: tuple[float, float], trial: Trial) -> Frame:
        """Answer the newest frame with this drive, and let the world go on."""
        world = {output.port: output for output in self.pending}
        now_ns = world["image"].capture_ns or 0
        (view,) = self.vision.handle(_event(now_ns, "image", world["image"]))
        (state,) = self.head.handle(_event(now_ns, "device", world["head"]))
        began_ns = time.thread_time_ns()  # processor time: the machine is shared
        answers = self.tracker.handle(_event(now_ns, "view", view)) + self.tracker.handle(_event(now_ns, "head", state))
        tracker_us = (time.thread_time_ns() - began_ns) / 1e3
        answer = {output.port: output for output in answers}
        (actuate,) = self.head.handle(_event(now_ns, "aim", answer["aim"]))
        applied = Output("applied", Applied(v_mps=drive[0], omega_radps=drive[1], commander="pilot"))
        self.tracker.handle(_event(now_ns, "applied", applied))
        command = Output("drive", BaseCommand(v_mps=drive[0], omega_radps=drive[1]))
        for port, output in (("drive", command), ("aim", actuate), ("trial", Output("trial", trial))):
            self.pending = self.simulator.handle(_event(now_ns, port, output))
        return Frame(world["truth"].message, answer["percept"].message, tracker_us)


def _event(now_ns: int, port: str, output: Output) -> Event:
    return Event(now_ns, port, output.message, now_ns)


def drives(loop: Loop, seed: int, count: int) -> Iterator[list[Frame]]:
    """Frames of some drives, each from a start of its own, from when the tracker sees the object."""
    for number in range(count):
        frame = loop.frame((0.0, 0.0), Trial(place=True, number=number, start=number))
        waited = 0
        while not (frame.percept.visible and frame.truth.start == number and waited > 1):
            frame = loop.frame((0.0, 0.0), Trial(number=number))
            waited += 1
            assert waited < LONGEST, "the tracker does not see the object"
        yield list(_drive(loop, np.random.default_rng([seed, number]), number))


def _drive(loop: Loop, rng: np.random.Generator, number: int) -> Iterator[Frame]:
    omega = TURN_RADPS
    for _ in range(LONGEST):
        frame = loop.frame((SPEED_MPS, omega), Trial(number=number))
        yield frame
        if frame.truth.d_axle_m < NEAREST_M:
            return
        omega = -omega if rng.random() < SWITCH else omega
        if abs(frame.truth.alpha_rad) > WIDEST_RAD:
            omega = math.copysign(TURN_RADPS, frame.truth.alpha_rad)


def errors(frames: list[Frame]) -> NDArray[np.float64]:
    """Errors `[N, 4]`: object from the image centre (px), bearing, depression, beta (deg)."""
    rows = []
    for truth, percept, _ in frames:
        tilt_rad = math.atan2(0.45, truth.d_axle_m)
        beta_rad = math.atan2(percept.slope, math.sin(percept.tilt_rad))
        rows.append(
            (
                math.hypot(truth.object_u_px, truth.object_v_px),
                abs(percept.pan_rad - truth.alpha_rad) / DEG,
                abs(percept.tilt_rad - tilt_rad) / DEG,
                abs(beta_rad - truth.beta_rad) / DEG,
            )
        )
    return np.array(rows)


def measure(seed: int, count: int, **tracker: Any) -> dict[str, float]:
    """Numbers of one setting of the tracker."""
    loop = Loop(seed, **tracker)
    kept: list[Frame] = []
    seen = total = 0
    for frames in drives(loop, seed, count):
        warm = frames[WARM_FRAMES:]
        total += len(warm)
        seen += sum(frame.percept.visible for frame in warm)
        kept += [frame for frame in warm if frame.percept.visible]
    table = errors(kept)
    numbers = {"frames": float(total), "seen_share": seen / total}
    for column, name in enumerate(("error_px", "bearing_error_deg", "tilt_error_deg", "beta_error_deg")):
        numbers[f"{name}_p50"], numbers[f"{name}_p95"] = np.percentile(table[:, column], (50, 95)).tolist()
    numbers["focal_px"] = kept[-1].percept.focal_px
    numbers["tracker_us_p50"] = float(np.median([frame.tracker_us for frame in kept]))
    return numbers


def run(seed: int = 1, count: int = 8) -> dict[str, float]:
    """All settings over the same drives; each number's name begins with its setting (`SETTINGS`)."""
    cv2.setNumThreads(1)
    found = {setting: measure(seed, count, **tracker) for setting, tracker in SETTINGS.items()}
    return {f"{setting}_{name}": value for setting, numbers in found.items() for name, value in numbers.items()}


def figures() -> list[Figure]:
    """What is asked of the tracker, beside what the paper's PD alone gives."""
    found = run()
    return [
        Figure("PD alone: object from the image centre, p95", found["pd_error_px_p95"], "px", note="the paper's"),
        Figure("feed-forward: object from the image centre, p95", found["ff_error_px_p95"], "px", at_most=8),
        Figure("error of the bearing, p95", found["ff_bearing_error_deg_p95"], "deg", at_most=0.5),
        Figure("error of beta, p95", found["ff_beta_error_deg_p95"], "deg"),
        Figure(
            "beta from the slope where it stands, p95",
            found["image_beta_error_deg_p95"],
            "deg",
            note="not referred to the image centre",
        ),
        Figure("tracker, per frame", found["ff_tracker_us_p50"], "us"),
    ]


def table(numbers: dict[str, float]) -> str:
    """The settings side by side."""
    names = [name.removeprefix("pd_") for name in numbers if name.startswith("pd_")]
    lines = [" " * 24 + "".join(f"{setting:>14}" for setting in SETTINGS)]
    lines += [f"{name:24}" + "".join(f"{numbers[f'{s}_{name}']:14.3f}" for s in SETTINGS) for name in names]
    return "\n".join(lines)


if __name__ == "__main__":
    result = run()
    print(json.dumps(result) if "--json" in sys.argv else table(result))
