"""Translates what is shown into Rerun's words. Rows are collected per entity and sent as columns, which is faster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
import rerun as rr

from viewer.shown import Dots, Lines, Number, Page, Picture, Point, Remark, Shown, What, Word

TIMELINE = "session"
_ROWS = 512
_BYTES = 2_000_000
"""An entity's rows are sent at the latest when they are so many or so large."""
_UNCONFIRMED_BYTES = 8_000_000
_ROW_BYTES = 100
_FAREWELL_S = 5.0
_PALETTE = ((31, 111, 235), (242, 140, 40), (26, 127, 55), (207, 34, 46), (130, 80, 223), (110, 119, 129))
_SPARSE = frozenset({"learning", "lost", "policy_size"})
_SERIES = 64


class RerunSink:
    """Writes to one Rerun recording."""

    def __init__(self, recording: rr.RecordingStream, *, patience_s: float, rows: int = _ROWS) -> None:
        """Write to an open recording.

        Args:
            recording: connected to a viewer or a file.
            patience_s: how long a viewer is waited for that does not take what it is sent; then it misses some.
            rows: collected per entity before they are sent unasked.
        """
        self._recording = recording
        self._patience_s = patience_s
        self._rows = rows
        self._waiting: dict[tuple[str, type[Any]], list[Shown]] = {}
        self._bytes = 0
        self._unconfirmed = 0
        """Bytes sent, about, since the viewer is known to have taken all of it."""
        self._series: dict[str, list[str]] = {}
        self.missed = 0
        """Rows that the viewer was not sent."""

    def stands(self, entities: Mapping[str, What]) -> None:
        """Show what is there at all times."""
        for entity, what in entities.items():
            columns = _COLUMNS[type(what)](entity, [what])
            self._recording.send_columns(entity, indexes=[], columns=columns)

    def show(self, shown: Iterable[Shown]) -> None:
        """Collect; what has become much is sent."""
        for each in shown:
            rows = self._waiting.setdefault((each.entity, type(each.what)), [])
            rows.append(each)
            self._bytes += len(each.what.data) if isinstance(each.what, Picture) else 0
            if len(rows) >= self._rows or self._bytes > _BYTES:
                self.flush()

    def flush(self) -> None:
        """Send what was collected, or forget it if the viewer hangs: the SDK would keep it all, without a bound."""
        rows_count = sum(map(len, self._waiting.values()))
        if self._keeps_up():
            self._send()
            self._unconfirmed += self._bytes + _ROW_BYTES * rows_count
        else:
            self.missed += rows_count
        self._waiting.clear()
        self._bytes = 0

    def _keeps_up(self) -> bool:
        if self._unconfirmed > _UNCONFIRMED_BYTES:
            try:
                self._recording.flush(timeout_sec=self._patience_s)
            except RuntimeError:
                return False
            self._unconfirmed = 0
        return True

    def _send(self) -> None:
        for (entity, kind), rows in self._waiting.items():
            if kind is Number:
                self._style(entity)
            times = rr.TimeColumn(TIMELINE, duration=np.array([row.time_ns for row in rows], "timedelta64[ns]"))
            columns = _COLUMNS[kind](entity, [row.what for row in rows])
            self._recording.send_columns(entity, indexes=[times], columns=columns)

    def _style(self, entity: str) -> None:
        """A colour for each series of a plot, and points for those that have few."""
        group, _, name = entity.partition("/")
        series = self._series.setdefault(group, [])
        if name in series or len(series) > _SERIES:
            return
        series.append(name)
        colour = _PALETTE[(len(series) - 1) % len(_PALETTE)]
        self._recording.log(entity, rr.SeriesLines(colors=[colour], names=[name], widths=[1.5]), static=True)
        if group in _SPARSE:
            self._recording.log(entity, rr.SeriesPoints(colors=[colour], names=[name], marker_sizes=[3]), static=True)

    def close(self) -> None:
        """Send the rest and wait until it is out."""
        self.flush()
        with suppress(RuntimeError):  # the viewer has been closed
            self._recording.flush(timeout_sec=_FAREWELL_S)
        self._recording.disconnect()


def _placed(entity: str, points: Sequence[Point]) -> list[Point]:
    """Rerun's plane has x to the right and y down; the plan's x points up and its y to the left."""
    return [(-y, -x) for x, y in points] if entity.startswith("plan") else list(points)


def _number(_: str, rows: list[Any]) -> Any:
    return rr.Scalars.columns(scalars=[row.value for row in rows])


def _word(_: str, rows: list[Any]) -> Any:
    return rr.StateChange.columns(state=[row.text for row in rows])


def _remark(_: str, rows: list[Any]) -> Any:
    levels = [rr.TextLogLevel.WARN if row.is_bad else rr.TextLogLevel.INFO for row in rows]
    return rr.TextLog.columns(text=[row.text for row in rows], level=levels)


def _page(_: str, rows: list[Any]) -> Any:
    kinds = [rr.MediaType.MARKDOWN] * len(rows)
    return rr.TextDocument.columns(text=[row.text for row in rows], media_type=kinds)


def _picture(_: str, rows: list[Any]) -> Any:
    kinds = [f"image/{row.format}" for row in rows]
    return rr.EncodedImage.columns(blob=[row.data for row in rows], media_type=kinds, opacity=[1.0] * len(rows))


def _lines(entity: str, rows: list[Lines]) -> Any:
    strips = [_placed(entity, strip) for row in rows for strip in row.strips]
    counts = [len(row.strips) for row in rows]
    per_strip = [row for row in rows for _ in row.strips]
    return rr.LineStrips2D.columns(
        strips=strips, colors=[row.colour for row in per_strip], radii=[-row.width_px / 2 for row in per_strip]
    ).partition(lengths=counts)


def _dots(entity: str, rows: list[Dots]) -> Any:
    counts = [len(row.points) for row in rows]
    per_dot = [row for row in rows for _ in row.points]
    return rr.Points2D.columns(
        positions=[at for row in rows for at in _placed(entity, row.points)],
        colors=[row.colour for row in per_dot],
        radii=[-row.radius_px for row in per_dot],
    ).partition(lengths=counts)


_COLUMNS: dict[type[Any], Callable[[str, list[Any]], Any]] = {
    Number: _number,
    Word: _word,
    Remark: _remark,
    Page: _page,
    Picture: _picture,
    Lines: _lines,
    Dots: _dots,
}
