"""A shadow beside who drove: where would it have done something else?

Compared are the frames in which a policy drove (the pilot on its way to the goal cell) or a person, and the shadow had
a word to say. They agree where their turn rates differ by less than half of the task's turn rate.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from components.pilot.sight import sight_of
from docking.task import Task
from runtime.params import ConfigurationError, build
from runtime.recorded_launch import specs_of
from runtime.recording import Logged
from schemas.trial_pb2 import Trial

_WAITING = 64
"""Frames that wait for their messages; the oldest is dropped (a message was lost)."""
_SHOWN = 10
_PERSON, _PILOT = "teleop", "pilot"
_GAP_S = 0.5
"""Disagreements closer than this are one stretch."""


class Beside(NamedTuple):
    """One frame in which both had a word to say."""

    time_s: float
    beta_rad: float
    alpha_rad: float
    driven_radps: float
    shadow_radps: float
    agrees: bool


@dataclass(frozen=True)
class Keys:
    """Where a session holds what is compared; empty = it has no shadow."""

    drive: str = ""
    advice: str = ""
    """The shadow's trial message."""
    applied: str = ""
    percept: str = ""
    trial: str = ""

    @staticmethod
    def of(launch: Mapping[str, Any]) -> Keys:
        """Of a resolved launch file, of whatever release."""
        for spec in specs_of(launch):
            if spec["params"].get("shadow") is True:
                outputs, inputs = spec["outputs"], spec["inputs"]
                base = str(inputs.get("base", "")).partition("/")[0]
                drive, advice = str(outputs.get("drive")), str(outputs.get("trial"))
                return Keys(drive, advice, f"{base}/applied", str(inputs.get("percept")), str(launch.get("trial", "")))
        return Keys()


class ShadowReader:
    """Folds a session's messages into compared frames."""

    def __init__(self, launch: Mapping[str, Any]) -> None:
        self.frames: list[Beside] = []
        keys = Keys.of(launch)
        self._names = {} if not keys.drive else {key: name for name, key in vars(keys).items() if key}
        self._task = task_of(launch)
        self._waiting: dict[int, dict[str, Any]] = {}

    def wants(self, topic: str) -> bool:
        """Whether messages of this topic are to be taken."""
        return topic in self._names

    def take(self, logged: Logged, message: Any) -> None:
        """Take one message of a topic that is wanted."""
        name = self._names[logged.topic]
        parts = self._waiting.setdefault(logged.capture_ns, {})
        parts[name] = message
        if len(parts) == len(self._names):
            del self._waiting[logged.capture_ns]
            self._compare(parts, logged.capture_ns)
        elif len(self._waiting) > _WAITING:
            self._waiting.pop(next(iter(self._waiting)))

    def _compare(self, parts: Mapping[str, Any], capture_ns: int) -> None:
        percept, applied, drive = parts["percept"], parts["applied"], parts["drive"]
        driven = applied.commander == _PERSON or (applied.commander == _PILOT and parts["trial"].mode == Trial.APPROACH)
        if not driven or parts["advice"].mode != Trial.APPROACH:
            return
        sight = sight_of(self._task, percept.visible, percept.slope, percept.pan_rad, percept.tilt_rad)
        difference = abs(drive.omega_radps - applied.omega_radps)
        if sight.visible and math.isfinite(difference):
            agrees = difference < 0.5 * self._task.turn_rate_radps
            rates = (applied.omega_radps, drive.omega_radps)
            self.frames.append(Beside(capture_ns * 1e-9, sight.beta_rad, sight.alpha_rad, *rates, agrees))

    def table(self) -> dict[str, Any]:
        """As a JSON object; empty if there is no shadow."""
        if not self._names:
            return {}
        count = len(self.frames)
        differences = [abs(frame.driven_radps - frame.shadow_radps) for frame in self.frames]
        return {
            "frames": count,
            "agree_percent": round(100 * sum(frame.agrees for frame in self.frames) / count, 1) if count else None,
            "mean_difference_degps": round(math.degrees(sum(differences) / count), 2) if count else None,
            "longest_differences": [_row(stretch) for stretch in longest(self.frames)],
        }


def longest(frames: list[Beside]) -> list[list[Beside]]:
    """The longest stretches of disagreement, longest first."""
    stretches: list[list[Beside]] = []
    for frame in frames:
        if frame.agrees:
            continue
        if stretches and frame.time_s - stretches[-1][-1].time_s <= _GAP_S:
            stretches[-1].append(frame)
        else:
            stretches.append([frame])
    return sorted(stretches, key=lambda stretch: stretch[0].time_s - stretch[-1].time_s)[:_SHOWN]


def _row(stretch: list[Beside]) -> dict[str, float]:
    first = stretch[0]
    return {
        "from_s": round(first.time_s, 3),
        "to_s": round(stretch[-1].time_s, 3),
        "beta_deg": round(math.degrees(first.beta_rad), 1),
        "alpha_deg": round(math.degrees(first.alpha_rad), 1),
        "driven_degps": round(math.degrees(first.driven_radps), 1),
        "shadow_degps": round(math.degrees(first.shadow_radps), 1),
    }


def task_of(launch: Mapping[str, Any]) -> Task:
    """The task of a session, from its resolved launch file."""
    table = launch.get("task")
    try:
        return build(Task, table if isinstance(table, dict) else {}, "task")
    except ConfigurationError:  # of another release
        return Task()
