"""Runs a script of phases: labels every frame with its phase, and ends early when something is not as it must be."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

from components.inspector.phase import Action, Phase
from components.inspector.ports import Params
from components.inspector.sample import Sample, of_phase
from components.inspector.script import script

_ASTRAY = 0.3
"""The object may move by this share of the image's width: more than all motions together."""
_DEEPER_PX = 6.0
"""Rows that the object may sink while the robot drives: 4 cm are two of them from 2 m, and four from 1.4 m."""
_ENDING_FRAMES = 16
"""Standing before the end is said: a base that was far too fast needs two seconds to brake."""


class Wish(NamedTuple):
    """What the robot is told in one frame."""

    pan_rad: float = 0.0
    tilt_rad: float = 0.0
    v_mps: float = 0.0
    omega_radps: float = 0.0
    gripper: int = Action.KEEP


class Robot(NamedTuple):
    """What is not in a sample."""

    bumper: bool
    stopped_by: str
    """Why base does not obey; empty = it does."""


@dataclass
class Run:
    """Where a script is."""

    params: Params
    phases: tuple[Phase, ...] = ()
    samples: list[Sample] = field(default_factory=list)
    reason: str = ""
    """Why it ended early, in one line."""
    _index: int = 0
    _first: Sample | None = None
    """The newest sample when the phase began."""
    _lost: int = 0
    _stopped: int = 0
    _wish: Wish = field(default_factory=Wish)
    _ending: int = 0

    def __post_init__(self) -> None:
        """Take the stage's script."""
        self.phases = self.phases or script(self.params)

    @property
    def done(self) -> bool:
        """The script is at its end, or was ended early, and the robot rests."""
        return self._ending >= _ENDING_FRAMES

    @property
    def phase(self) -> str:
        """Name of the present phase."""
        return self.phases[min(self._index, len(self.phases) - 1)].name

    def end(self, reason: str) -> None:
        """Stop here. The first reason counts."""
        self.reason = self.reason or reason

    def step(self, sample: Sample, robot: Robot) -> Wish:
        """Take one frame, `sample.phase` not yet filled in."""
        if not self.reason and self._index < len(self.phases):
            sample = sample._replace(phase=self.phase)
            self.samples.append(sample)
            self._first = self._first or sample
            self.end(self._hindrance(sample, robot))
        if self.reason or self._index >= len(self.phases):
            self._ending += 1
            return self._wish._replace(v_mps=0.0, omega_radps=0.0, gripper=Action.KEEP)
        self._advance(sample)
        self._wish = self._told()
        return self._wish

    def _advance(self, now: Sample) -> None:
        """Go on to the phase that is not over yet."""
        while self._index < len(self.phases) and self._is_over(self.phases[self._index], now):
            check = self.phases[self._index].check
            self.end("" if check is None else check(self.samples))
            self._index += 1
            self._first = now

    def _is_over(self, phase: Phase, now: Sample) -> bool:
        first = self._first or now
        if phase.as_long_as:
            frames = len(of_phase(self.samples, phase.as_long_as))
            return len(of_phase(self.samples, phase.name)) >= frames
        ended = phase.until is not None and phase.until(first, now)
        return ended or (now.time_ns - first.time_ns) * 1e-9 > phase.longest_s - 0.5 * self.params.frame_s

    def _told(self) -> Wish:
        if self._index >= len(self.phases) or self.reason:
            return self._wish._replace(v_mps=0.0, omega_radps=0.0, gripper=Action.KEEP)
        phase = self.phases[self._index]
        gripper = phase.gripper if isinstance(phase.gripper, Action) else phase.gripper(self.samples)
        return Wish(phase.pan_rad, phase.tilt_rad, phase.v_mps, phase.omega_radps, gripper)

    def _hindrance(self, now: Sample, robot: Robot) -> str:
        """Why the script can not go on; empty = it can."""
        if robot.bumper:
            return f"the bumper is pressed ({self.phase})"
        self._stopped = self._stopped + 1 if robot.stopped_by else 0
        if self._stopped > self.params.lost_frames:
            return f"base does not obey: {robot.stopped_by} ({self.phase})"
        return self._gripper_begins() if self.params.stage == "fingertips" else self._sight(now)

    def _gripper_begins(self) -> str:
        first = self.samples[0]
        if not first.lift_down:
            return "the lift must be down in the beginning; its lower end switch says that it is not"
        return "the fingers must be open in the beginning; their switch says closed" if first.closed else ""

    def _sight(self, now: Sample) -> str:
        if not (math.isfinite(now.pan_rad) and math.isfinite(now.tilt_rad)):
            return f"the head's encoders can not be read ({self.phase})"
        first = self.samples[0]
        if max(abs(first.pan_rad), abs(first.tilt_rad)) > self.params.zero_rad:
            return (
                f"the head must be at its zero in the beginning; it reads pan {math.degrees(first.pan_rad):.1f}, "
                f"tilt {math.degrees(first.tilt_rad):.1f} deg"
            )
        self._lost = 0 if now.visible else self._lost + 1
        if self._lost > self.params.lost_frames:
            return f"the object is not in the image ({self.phase})"
        seen = next((sample for sample in self.samples if sample.visible), now)
        way_px = max(abs(now.u_px - seen.u_px), abs(now.v_px - seen.v_px)) if now.visible else 0.0
        if way_px > _ASTRAY * self.params.width_px or self._deeper_px(now) > _DEEPER_PX:
            return f"the object moved far more in the image than was asked for ({self.phase})"
        return ""

    def _deeper_px(self, now: Sample) -> float:
        """Rows that the object moved since a drive began."""
        drives = now.visible and self._first is not None and self._first.visible and bool(self._wish.v_mps)
        return abs(now.v_px - self._first.v_px) if drives and self._first is not None else 0.0
