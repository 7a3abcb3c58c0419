"""What was found out about one thing of the robot, as plain values."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

CLOSE_ENOUGH = 1.2
"""A factor between this and its inverse is right: lenses, soft floors and slipping wheels make as much."""
UNITS = {180.0 / math.pi: "degrees", 1000.0: "thousandths", 100.0: "hundredths"}
"""Factors that have a name."""


class Verdict(IntEnum):
    """Numbers of `berth.Finding.Verdict`."""

    GOOD = 0
    WRONG = 1
    UNKNOWN = 2


class Change(IntEnum):
    """Numbers of `berth.Finding.Change`."""

    NOTHING = 0
    MULTIPLY = 1
    FLIP = 2
    SET = 3


class Judgement(NamedTuple):
    """One line of the table, and the parameter that puts it right."""

    thing: str
    verdict: Verdict
    words: str
    measured: float = 0.0
    unit: str = ""
    component: str = ""
    param: str = ""
    change: Change = Change.NOTHING
    value: float = 0.0


def unknown(thing: str, words: str) -> Judgement:
    """It could not be found out; the words say why."""
    return Judgement(thing, Verdict.UNKNOWN, words)


def scaled(thing: str, ratio: float, component: str, param: str, *, exact: bool = False) -> Judgement:
    """A quantity that must be 1.

    Args:
        thing: what it is.
        ratio: by which the parameter must be divided: what came out for what went in.
        component: package whose parameter it is.
        param: the parameter.
        exact: the ratio is worth correcting by, not only its sign and its unit.
    """
    factor = _snapped(1.0 / ratio, exact=exact)
    if factor == 1.0:
        return Judgement(thing, Verdict.GOOD, f"ratio {ratio:.2f}", ratio)
    words = "the wrong way round" if factor == -1.0 else f"wrong by a factor of {1 / factor:.4g}{_named(factor)}"
    return Judgement(thing, Verdict.WRONG, words, ratio, "", component, param, Change.MULTIPLY, factor)


def flag(thing: str, wrong: bool, words: str, param: str) -> Judgement:
    """A yes or no of the base that must be no."""
    if not wrong:
        return Judgement(thing, Verdict.GOOD, "")
    return Judgement(thing, Verdict.WRONG, words, component="components.base", param=param, change=Change.FLIP)


def _snapped(factor: float, *, exact: bool) -> float:
    """The nearest factor that has a reason."""
    size = abs(factor)
    for known in (1.0, *UNITS, *(1.0 / unit for unit in UNITS)):
        if known / CLOSE_ENOUGH <= size <= known * CLOSE_ENOUGH:
            return math.copysign(known if known == 1.0 or not exact else size, factor)
    return factor


def has_name(factor: float) -> bool:
    """Whether a factor is that of a unit that people confuse."""
    return bool(_named(factor))


def _named(factor: float) -> str:
    size = max(abs(factor), 1.0 / abs(factor))
    name = next((name for unit, name in UNITS.items() if unit / CLOSE_ENOUGH <= size <= unit * CLOSE_ENOUGH), "")
    return f": {name}?" if name else ""
