"""The report's pictures, as PNG bytes. Matplotlib is imported only by who draws."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from typing import Any

import cv2
import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from docking.score import Trial
from report.shadow import Beside
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


def _figure(width: float, height: float, columns: int = 1) -> tuple[Figure, list[Axes]]:
    with mpl.rc_context(STYLE):
        figure, axes = plt.subplots(1, columns, figsize=(width, height), layout="constrained", squeeze=False)
    return figure, list(axes[0])


def _png(figure: Figure) -> bytes:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=110)
    plt.close(figure)
    return buffer.getvalue()


def learning_curve(trials: Sequence[Trial], window: int = 20) -> bytes:
    """Share of trials that reached the goal cell, over the last `window` trials of each controller."""
    figure, (axes,) = _figure(7.2, 2.8)
    for controller in sorted({trial.controller for trial in trials}):
        own = [trial for trial in trials if trial.controller == controller]
        minutes = [trial.ended_s / 60 for trial in own]
        share = [100 * np.mean([t.reached for t in own[max(0, i - window + 1) : i + 1]]) for i in range(len(own))]
        axes.plot(minutes, share, label=f"{controller} ({len(own)} trials)", linewidth=1.6)
    axes.set(xlabel="robot minutes", ylabel=f"goal cell reached, %\n(last {window} trials)", ylim=(-3, 103))
    if trials:
        axes.legend(loc="lower right", frameon=False)
    return _png(figure)


def controllability(curve: Sequence[tuple[float, float]], ceiling_percent: float) -> bytes:
    """Share of the starts from which the policy of each minute reaches the goal cell."""
    figure, (axes,) = _figure(7.2, 2.8)
    axes.plot(*zip(*curve, strict=True), color=COLOURS["docked"], marker="o", markersize=2.5, label="frozen policy")
    axes.axhline(ceiling_percent, color="#57606a", linestyle="--", label="best that is possible")
    axes.set(xlabel="robot minutes", ylabel="goal cell reached, %", ylim=(-3, 103), xlim=(0, None))
    axes.legend(loc="lower right", frameon=False)
    return _png(figure)


def plan_view(trials: Sequence[Trial], edge_offset_m: float, title: str) -> bytes:
    """Paths of the axle seen from above; the object at the origin, the table ahead."""
    figure, (axes,) = _figure(4.6, 3.9)
    draw_paths(axes, trials, edge_offset_m)
    axes.set_title(title)
    return _png(figure)


def draw_paths(axes: Axes, trials: Sequence[Trial], edge_offset_m: float) -> None:
    """Table, can and the path of every trial, coloured by what became of it."""
    draw_table(axes, edge_offset_m)
    for trial in trials:
        kind = "docked" if trial.docked else "reached" if trial.reached else "failed"
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


def policy_maps(policy: Policy) -> bytes:
    """Action and value of every cell."""
    figure, axes = _figure(7.6, 3.2, 2)
    draw_policy(axes[0], policy)
    axes[0].set_title("policy: blue = turn left, orange = turn right")
    value = np.array(policy.value, float)
    value[np.frombuffer(policy.action, np.int8) < 0] = np.nan
    image = _draw_cells(axes[1], policy, value, "viridis", None)
    axes[1].set_title("value (300 = at the goal)")
    figure.colorbar(image, ax=axes[1])
    return _png(figure)


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


def beside(frames: Sequence[Beside]) -> bytes:
    """Where in (beta, alpha) a shadow would have turned as the robot did, and where not."""
    figure, (axes,) = _figure(5.0, 4.0)
    for agrees, label, colour in ((True, "alike", COLOURS["docked"]), (False, "otherwise", COLOURS["failed"])):
        own = [frame for frame in frames if frame.agrees == agrees]
        across, up = ([math.degrees(angle) for angle in angles] for angles in _angles(own))
        axes.scatter(across, up, s=6, c=colour, label=f"{label} ({len(own)})")
    axes.set(xlabel="alpha, deg", ylabel="beta, deg")
    axes.legend(loc="upper right", frameon=False)
    return _png(figure)


def _angles(frames: Sequence[Beside]) -> tuple[list[float], list[float]]:
    return [frame.alpha_rad for frame in frames], [frame.beta_rad for frame in frames]


def camera_strip(pictures: Mapping[str, bytes]) -> bytes:
    """The newest camera image of each mode of the pilot, side by side, as the robot saw it."""
    tiles = []
    for mode in ("APPROACH", "SERVO", "GRASP", "REVERSE"):
        image = cv2.imdecode(np.frombuffer(pictures.get(mode, b"\0"), np.uint8), cv2.IMREAD_COLOR)
        if image is None:
            continue
        tile = cv2.resize(image, (320, 240))
        cv2.putText(tile, mode.lower(), (8, 230), cv2.FONT_HERSHEY_SIMPLEX, 0.55, (255, 255, 255), 1, cv2.LINE_AA)
        cv2.drawMarker(tile, (160, 120), (255, 255, 255), cv2.MARKER_CROSS, 14, 1)
        tiles.append(tile)
    strip = np.hstack(tiles) if tiles else np.zeros((8, 8, 3), np.uint8)
    return bytes(cv2.imencode(".png", strip)[1].tobytes())


def tracking(errors_px: Sequence[float], bearings_rad: Sequence[float]) -> bytes:
    """Distribution of the can's distance from the image centre, and of the bearing's error."""
    figure, axes = _figure(7.2, 2.4, 2)
    for panel, values, label in (
        (axes[0], np.asarray(errors_px), "can from the image centre, px"),
        (axes[1], np.degrees(np.asarray(bearings_rad)), "error of the bearing, deg"),
    ):
        if values.size:
            p95 = float(np.percentile(values, 95))
            panel.hist(values, bins=60, range=(0, max(1e-6, 2.5 * p95)), color="#57606a")
            panel.axvline(p95, color=COLOURS["failed"], label=f"95 %: {p95:.2f}")
            panel.legend(frameon=False)
        panel.set(xlabel=label, ylabel="frames")
    return _png(figure)
