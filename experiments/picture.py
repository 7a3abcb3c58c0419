"""Pictures as files, without a display."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

WIDTH_IN = 10.0
_STYLE = {
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "savefig.dpi": 130,
    "svg.hashsalt": "berth",
}


def picture(
    path: Path,
    paint: Callable[[list[Axes]], None],
    *,
    rows: int = 1,
    columns: int = 1,
    height_in: float = 4.0,
    heights_in: Sequence[float] | None = None,
) -> Path:
    """Make a figure of rows by columns axes, let `paint` fill them (row by row), save it as PNG; returns its path."""
    with mpl.rc_context(_STYLE):  # type: ignore[arg-type]
        heights = heights_in or [height_in] * rows
        figure = Figure(figsize=(WIDTH_IN, sum(heights)), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False, height_ratios=heights)
        paint(list(axes.flat))
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, metadata={"Software": None})
    return path
