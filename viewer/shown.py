"""The few words in which a session is shown; every viewer translates these and nothing else.

An entity's name says in which frame its points are: below `camera` pixels of the image, u to the right and v down from
its upper left corner; below `policy` pixels of that picture; below `plan` the world of `docking.plant` (x along the
table's inward normal, y to the left), in metres or, where no length is known, in camera heights.
"""

from __future__ import annotations

import math
from typing import NamedTuple

Point = tuple[float, float]
Colour = tuple[int, int, int, int]
"""Red, green, blue, opacity, 0 to 255."""


class Number(NamedTuple):
    """A value that is plotted over time; its unit ends the entity's name."""

    value: float


class Word(NamedTuple):
    """A state that lasts until the next one."""

    text: str


class Remark(NamedTuple):
    """A line of the log."""

    text: str
    is_bad: bool = False


class Page(NamedTuple):
    """A text that replaces the former one, in Markdown."""

    text: str


class Picture(NamedTuple):
    """An encoded image."""

    data: bytes
    format: str
    """jpeg or png."""


class Lines(NamedTuple):
    """Polygonal lines of one colour."""

    strips: tuple[tuple[Point, ...], ...]
    colour: Colour
    width_px: float = 2.0
    lasts_s: float = math.inf
    """Fades after so much session time; else it stays until the entity's next lines."""


class Dots(NamedTuple):
    """Points of one colour; none = what was there is gone."""

    points: tuple[Point, ...]
    colour: Colour
    radius_px: float = 4.0


What = Number | Word | Remark | Page | Picture | Lines | Dots


class Shown(NamedTuple):
    """What an entity looks like from a moment of the session on."""

    entity: str
    time_ns: int
    """Session time."""
    what: What
