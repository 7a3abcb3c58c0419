"""What a poster or a film draws with matplotlib; it is imported only by who draws. Pages have `report.charts`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle

from docking.score import Trial
from report.charts import kind_of
from schemas.policy_pb2 import Policy

mpl.use("Agg")
COLOURS = {"docked": "#1a7f37", "reached": "#1f6feb", "failed": "#cf222e"}
"""One colour per outcome, in every picture."""
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "axes.spines.top": False,
    "axes.spines.right": False,
}


def draw_paths(axes: Axes, trials: Sequence[Trial], edge_offset_m: float) -> None:
    """Table, can and the path of every trial, coloured by what became of it."""
    draw_table(axes, edge_offset_m)
    for trial in trials:
        kind = kind_of(trial)
        x_m, y_m = zip(*trial.path, strict=True) if trial.path else ((), ())
        axes.plot([-y for y in y_m], x_m, color=COLOURS[kind], linewidth=0.9, alpha=0.75)
        if x_m:
            axes.plot(-y_m[0], x_m[0], "o", color=COLOURS[kind], markersize=2.5)
    for kind, colour in COLOURS.items():
        axes.plot([], [], color=colour, label=kind)
    axes.set(xlim=(-1.8, 1.8), ylim=(-2.6, 0.45), xlabel="m", ylabel="m", aspect="equal")
    axes.legend(loc="lower center", ncols=3, frameon=False, columnspacing=1.0)


def draw_table(axes: Axes, edge_offset_m: float) -> None:
    """Table, stripe and can from above (world x upwards, y to the left)."""
    axes.add_patch(Rectangle((-5, -edge_offset_m), 10, 5, color="#d8c9ae", zorder=0))
    axes.axhline(-edge_offset_m, color="#f28c28", linewidth=2.5, zorder=1)
    axes.add_patch(Circle((0, 0), 0.033, color="#2e8b57", zorder=3))


def draw_policy(axes: Axes, policy: Policy) -> None:
    """Action of every cell; white where nothing is known."""
    action = np.frombuffer(policy.action, np.int8).astype(float)
    action[action < 0] = np.nan
    _draw_cells(axes, policy, action, mpl.colors.ListedColormap(["#1f6feb", "#f2a33c"]), (0.0, 1.0))


def _draw_cells(axes: Axes, policy: Policy, values: Any, colours: Any, limits: tuple[float, float] | None) -> Any:
    beta, alpha = math.degrees(policy.beta_range_rad), math.degrees(policy.alpha_range_rad)
    image = axes.imshow(
        values.reshape(policy.beta_cells, policy.alpha_cells),
        origin="lower",
        extent=(-alpha, alpha, -beta, beta),
        aspect="auto",
        cmap=colours,
        clim=limits,
    )
    axes.grid(visible=False)
    axes.set(xlabel="alpha, bearing of the object, deg", ylabel="beta, deg")
    axes.plot(0, 0, "+", color="white", markersize=9)
    return image
