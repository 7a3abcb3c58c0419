"""One frame as the learner sees it: what was perceived, what was executed, and where the trial was."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from components.learner.ports import Params
from docking.cells import SINK, Grid

UNKNOWN_ACTION = -1
"""What was executed is none of the task's actions."""
_STEEPEST = 1e3
"""Slopes beyond this, 0.06 deg from upright, are no table edges."""


class Percept(NamedTuple):
    """Of one frame, relative to the goal."""

    visible: bool
    cell: int
    """Or SINK."""
    beta_rad: float
    alpha_rad: float
    too_close: bool
    """Beyond the tilt limit."""
    tilt_rad: float = 0.0
    """Not relative to the goal's."""


class Progress(NamedTuple):
    """Of the trial in one frame."""

    training: bool
    """The session is in its training phase."""
    learning: bool
    """The robot approaches the object in a training trial."""
    began_ns: int
    """Names the trial."""
    ended: int
    """Trials ended in this phase so far."""


class Frame(NamedTuple):
    """All of one frame."""

    capture_ns: int
    percept: Percept
    progress: Progress
    action: int
    """Index of the action that was executed, or UNKNOWN_ACTION."""
    command: tuple[float, float] = (0.0, 0.0)
    """What was executed, m/s and rad/s."""


def frame_of(row: list[Any]) -> Frame:
    """A frame out of nested lists, as JSON gives it back.

    Raises:
        TypeError, ValueError: it is nothing of the kind.
    """
    capture_ns, percept, progress, action, command = row
    return Frame(int(capture_ns), Percept(*percept), Progress(*progress), int(action), command_of(command))


def command_of(pair: list[Any]) -> tuple[float, float]:
    """Speed and turn rate out of a list.

    Raises:
        TypeError, ValueError: it is nothing of the kind.
    """
    v_mps, omega_radps = pair
    return float(v_mps), float(omega_radps)


UNSEEN = Percept(visible=False, cell=SINK, beta_rad=0.0, alpha_rad=0.0, too_close=False)


def percept_of(params: Params, grid: Grid, visible: bool, slope: float, pan_rad: float, tilt_rad: float) -> Percept:
    """The cell of a percept; numbers that no head and no table edge can give count as not seen."""
    sane = abs(slope) < _STEEPEST and abs(pan_rad) <= math.pi and 0.0 < tilt_rad < math.pi / 2  # false for NaN
    if not (visible and sane):
        return UNSEEN
    seen = params.task.seen(slope, pan_rad, tilt_rad)
    return Percept(
        visible=True,
        cell=grid.cell(seen.beta_rad, seen.alpha_rad),
        beta_rad=seen.beta_rad,
        alpha_rad=seen.alpha_rad,
        too_close=seen.too_close,
        tilt_rad=seen.tilt_rad,
    )


def action_of(params: Params, v_mps: float, omega_radps: float) -> int:
    """Index of the task's action that speed and turn rate equal within the tolerances, or UNKNOWN_ACTION."""
    for index, (v, omega) in enumerate(params.task.actions):
        if abs(v_mps - v) <= params.speed_tolerance_mps and abs(omega_radps - omega) <= params.turn_tolerance_radps:
            return index
    return UNKNOWN_ACTION
