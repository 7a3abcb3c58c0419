"""Which way lift and fingers run, and what the break beams read, judged by the gripper's own switches."""

from __future__ import annotations

from collections.abc import Sequence

from components.inspector.judgement import Judgement, flag, unknown
from components.inspector.phase import Action
from components.inspector.sample import Sample, of_phase


def judge(samples: Sequence[Sample], *, swapped_in_force: bool) -> list[Judgement]:
    """Lift, fingers, beams.

    Args:
        samples: of the whole stage.
        swapped_in_force: base swaps the beams already.
    """
    return [_lift(samples), _fingers(samples), *_beams(samples, swapped_in_force=swapped_in_force)]


def safe_action(samples: Sequence[Sample]) -> int:
    """What should open the fingers and leaves the lift down, whichever way the lift runs."""
    return Action.RELEASE if _runs(samples, "lift", lift=True) is False else Action.LOWER


def open_action(samples: Sequence[Sample]) -> int:
    """What opens the fingers and leaves the lift down, whichever way both run."""
    return Action.CLOSE if _runs(samples, "close", lift=False) is False else safe_action(samples)


def _runs(samples: Sequence[Sample], phase: str, *, lift: bool) -> bool | None:
    """Whether a motor's switch changed in the phase that moves it away from where it stood; None = not tried."""
    rows = of_phase(samples, phase)
    if not rows:
        return None
    before = [row for row in samples if row.time_ns < rows[0].time_ns][-1:]
    read = [row.lift_down if lift else row.closed for row in (*before, *rows)]
    return read[0] != read[-1]


def _lift(samples: Sequence[Sample]) -> Judgement:
    if _runs(samples, "lift", lift=True):
        return flag("lift", False, "", "lift_reversed")
    if _runs(samples, "lower", lift=True):
        return flag("lift", True, "it goes up when it is told to go down", "lift_reversed")
    return unknown("lift", "its lower end switch did not change")


def _fingers(samples: Sequence[Sample]) -> Judgement:
    if _runs(samples, "close", lift=False):
        return flag("fingers", False, "", "fingers_reversed")
    if _runs(samples, "lower", lift=False) or _runs(samples, "open", lift=False):
        return flag("fingers", True, "they close when they are told to open", "fingers_reversed")
    return unknown("fingers", "they were never closed by what their switch says")


def _beams(samples: Sequence[Sample], *, swapped_in_force: bool) -> list[Judgement]:
    """With nothing between the fingers both read whole; then the object breaks the outer one first.

    Base inverts a beam by its device's name, before it swaps the two.
    """
    first = samples[0]
    words = "it reads broken while nothing is there"
    names = ("outer", "inner") if swapped_in_force else ("inner", "outer")
    found = [
        flag("inner beam", first.inner, words, f"{names[0]}_beam_inverted"),
        flag("outer beam", first.outer, words, f"{names[1]}_beam_inverted"),
    ]
    inner, outer = _breaks(samples, "inner"), _breaks(samples, "outer")
    if inner is None and outer is None:
        return [*found, unknown("beams' order", "neither changed when the object should have come between the fingers")]
    if inner == outer:
        return [*found, unknown("beams' order", "both changed at once")]
    swapped = inner is not None and (outer is None or inner < outer)
    return [*found, flag("beams' order", swapped, "the object breaks the inner one first", "beams_swapped")]


def _breaks(samples: Sequence[Sample], beam: str) -> int | None:
    """When a beam first reads otherwise than in the beginning."""
    rows = [row for row in samples if row.phase in {"rest", "creep", "stand"}]
    read = [(row.time_ns, row.inner if beam == "inner" else row.outer) for row in rows]
    return next((time_ns for time_ns, value in read if value != read[0][1]), None)
