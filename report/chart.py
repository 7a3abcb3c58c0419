"""Charts as inline SVG: drawn for a phone's width, coloured by the page's style sheet, so light, dark and paper agree.

Coordinates of a chart are its data's; it is `WIDTH` units wide, which is about the width of a phone in pixels.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import NamedTuple

WIDTH = 360.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 44.0, 14.0, 8.0, 34.0
_TICKS = 5
Point = tuple[float, float]


class Key(NamedTuple):
    """One entry of a legend."""

    mark: str
    """Class of the style sheet: a colour and a dash."""
    words: str


@dataclass(frozen=True)
class Axis:
    """One axis: a range, linear or logarithmic."""

    low: float
    high: float
    label: str = ""
    log: bool = False

    def share(self, value: float) -> float:
        """Where a value lies, 0 at `low`, 1 at `high`."""
        if self.log:
            value, low, high = (math.log10(max(x, 1e-12)) for x in (value, self.low, self.high))
        else:
            low, high = self.low, self.high
        return (value - low) / (high - low) if high > low else 0.0

    def ticks(self) -> list[float]:
        """Round numbers within the range; powers of ten on a logarithmic axis."""
        if self.log:
            powers = range(math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9) + 1)
            return [10.0**power for power in powers]
        step = _round_step(self.high - self.low)
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [index * step for index in range(first, last + 1)]


def _round_step(span: float) -> float:
    rough = max(span, 1e-9) / _TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    return power * next(factor for factor in (1.0, 2.0, 2.5, 5.0, 10.0) if factor * power >= rough * (1 - 1e-9))


@dataclass
class Chart:
    """Axes and what is drawn into them, in order."""

    x: Axis
    y: Axis
    height: float = 210.0
    grid: bool = True
    """Lines at the ticks."""
    rows: bool = True
    """Numbers at the vertical axis."""
    parts: list[str] = field(default_factory=list)

    def place(self, x: float, y: float) -> Point:
        """SVG coordinates of a point of the data, kept near the frame."""
        across, up = (min(max(share, -0.5), 1.5) for share in (self.x.share(x), self.y.share(y)))
        wide, high = WIDTH - _LEFT - _RIGHT, self.height - _TOP - _BOTTOM
        return _LEFT + across * wide, _TOP + (1.0 - up) * high

    def line(self, points: Iterable[Point], mark: str) -> None:
        """A line through points; those that are not finite are left out."""
        places = " ".join(f"{u:.1f},{v:.1f}" for u, v in self._places(points))
        if places:
            self.parts.append(f"<polyline class='line {mark}' points='{places}'/>")

    def band(self, points: Iterable[tuple[float, float, float]], mark: str) -> None:
        """The area between two lines: (x, low, high)."""
        rows = list(points)
        around = [(x, low) for x, low, _ in rows] + [(x, high) for x, _, high in reversed(rows)]
        places = " ".join(f"{u:.1f},{v:.1f}" for u, v in self._places(around))
        self.parts.append(f"<polygon class='band {mark}' points='{places}'/>")

    def dots(self, points: Iterable[Point], mark: str, radius: float = 2.6) -> None:
        """A circle at each point."""
        for u, v in self._places(points):
            self.parts.append(f"<circle class='dot {mark}' cx='{u:.1f}' cy='{v:.1f}' r='{radius:g}'/>")

    def crosses(self, points: Iterable[Point], mark: str, size: float = 3.5) -> None:
        """A cross at each point: what failed is told by shape too."""
        strokes = (
            f"M{u - size:.1f} {v - size:.1f}l{2 * size:g} {2 * size:g}m0 {-2 * size:g}l{-2 * size:g} {2 * size:g}"
            for u, v in self._places(points)
        )
        path = "".join(strokes)
        if path:
            self.parts.append(f"<path class='line {mark}' d='{path}'/>")

    def bars(self, edges: Sequence[float], heights: Sequence[float], mark: str, part: tuple[int, int] = (0, 1)) -> None:
        """A histogram: a bar between each edge and the next, or the i-th of n beside one another, part = (i, n)."""
        number, parts = part
        for low, high, value in zip(edges, edges[1:], heights, strict=False):
            if value > 0:
                width = (high - low) / parts
                (u, v), (end, base) = self.place(low + number * width, value), self.place(low + (number + 1) * width, 0)
                self.parts.append(
                    f"<rect class='area {mark}' x='{u + 0.3:.1f}' y='{v:.1f}' width='{max(end - u - 0.6, 0.4):.1f}' "
                    f"height='{base - v:.1f}'/>"
                )

    def box(self, low: Point, high: Point, mark: str) -> None:
        """A filled rectangle, clipped to the frame."""
        (u, bottom), (end, v) = self.place(*self._clipped(low)), self.place(*self._clipped(high))
        self.parts.append(
            f"<rect class='area {mark}' x='{u:.1f}' y='{v:.1f}' width='{end - u:.1f}' height='{bottom - v:.1f}'/>"
        )

    def level(self, y: float, mark: str) -> None:
        """A horizontal line all across."""
        self.line([(self.x.low, y), (self.x.high, y)], mark)

    def upright(self, x: float, mark: str) -> None:
        """A vertical line all across."""
        self.line([(x, self.y.low), (x, self.y.high)], mark)

    def text(self, x: float, y: float, words: str, anchor: str = "middle") -> None:
        """Words at a point."""
        u, v = self.place(x, y)
        self.parts.append(f"<text x='{u:.1f}' y='{v:.1f}' text-anchor='{anchor}'>{escape(words)}</text>")

    def image(self, png: bytes) -> None:
        """A picture that fills the frame, its pixels kept sharp."""
        (u, v), (end, bottom) = self.place(self.x.low, self.y.high), self.place(self.x.high, self.y.low)
        self.parts.append(
            f"<image class=cells x='{u:.1f}' y='{v:.1f}' width='{end - u:.1f}' height='{bottom - v:.1f}' "
            f"preserveAspectRatio='none' href='{data_of(png)}'/>"
        )

    def svg(self, words: str) -> str:
        """The chart; `words` tell what it shows to who can not see it."""
        frame = self._frame() if self.grid else ""
        return (
            f"<svg viewBox='0 0 {WIDTH:g} {self.height:g}' role=img aria-label='{escape(words, quote=True)}'>"
            f"{frame}{''.join(self.parts)}{self._labels()}</svg>"
        )

    def _places(self, points: Iterable[Point]) -> Iterable[Point]:
        return (self.place(x, y) for x, y in points if math.isfinite(x) and math.isfinite(y))

    def _clipped(self, point: Point) -> Point:
        x, y = point
        return min(max(x, self.x.low), self.x.high), min(max(y, self.y.low), self.y.high)

    def _frame(self) -> str:
        lines = []
        for tick in self.y.ticks():
            (u, v), (end, _) = self.place(self.x.low, tick), self.place(self.x.high, tick)
            lines.append(f"M{u:.1f} {v:.1f}H{end:.1f}")
        for tick in self.x.ticks():
            (u, v), (_, end) = self.place(tick, self.y.low), self.place(tick, self.y.high)
            lines.append(f"M{u:.1f} {v:.1f}V{end:.1f}")
        return f"<path class=grid d='{''.join(lines)}'/>"

    def _labels(self) -> str:
        base, middle = self.height - _BOTTOM, _TOP + (self.height - _TOP - _BOTTOM) / 2
        places = [(tick, self.place(tick, self.y.low)[0]) for tick in self.x.ticks()]
        words = [f"<text x='{u:.1f}' y='{base + 13:.1f}' text-anchor=middle>{short(tick)}</text>" for tick, u in places]
        places = [(tick, self.place(self.x.low, tick)[1]) for tick in self.y.ticks()] if self.rows else []
        words += [f"<text x='{_LEFT - 5:g}' y='{v + 4:.1f}' text-anchor=end>{short(tick)}</text>" for tick, v in places]
        across = (_LEFT + WIDTH - _RIGHT) / 2
        words.append(f"<text class=name x='{across:g}' y='{self.height - 5:g}'>{escape(self.x.label)}</text>")
        words.append(f"<text class=name transform='translate(11 {middle:g}) rotate(-90)'>{escape(self.y.label)}</text>")
        return "".join(words)


def short(value: float) -> str:
    """A tick's number, without needless zeros."""
    return f"{0.0 if abs(value) < 1e-12 else value:.6g}".replace("-", "\N{MINUS SIGN}")


def span(values: Iterable[float], least: float = 1.0) -> tuple[float, float]:
    """From 0 to a little above the largest finite value, at least `least`."""
    top = max((value for value in values if math.isfinite(value)), default=0.0)
    return 0.0, max(1.05 * top, least)


def data_of(png: bytes, kind: str = "png") -> str:
    """A picture as a data address."""
    return f"data:image/{kind};base64,{base64.b64encode(png).decode()}"
