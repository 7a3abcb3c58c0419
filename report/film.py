"""A short film of a session: what the camera saw, where the robot drove, what it knew, and how well that did."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, cast

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle
from numpy.typing import NDArray
from PIL import Image

from docking.score import Trial
from report.charts import kind_of
from report.comparison import Comparison
from report.overlay import camera_picture
from report.pictures import COLOURS, STYLE, draw_table
from report.reel import Reel
from report.screenplay import Cue
from schemas.policy_pb2 import Policy

SIZE_PX = (960, 720)
QUALITY = 80
KEY_PICTURES = (24, 48)
"""Fewest and most pictures from one that is whole to the next; the others hold what changed."""
EDGE_OFFSET_M = 0.05
"""From the table's edge to the object, as it is drawn."""
PATHS = 40
"""Ended trials whose paths stay."""
RADIUS_M, GRIPPER_M = 0.18, 0.28
"""Of the robot as it is drawn."""
_INK, _PALE = "#1f2328", "#57606a"
_TURNS = np.array([(31, 111, 235, 255), (242, 163, 60, 255), (143, 183, 245, 255), (249, 209, 158, 255)], np.uint8)
"""Left, right; at the second speed, or backwards, paler."""

Rgb = NDArray[np.uint8]


class Stage:
    """Four panels and a line of words; `picture` draws one cue of the film."""

    def __init__(self, reel: Reel, comparison: Comparison) -> None:
        """Draw what never changes."""
        self._reel, self._comparison = reel, comparison
        with mpl.rc_context(STYLE):
            self._figure = plt.figure(figsize=(SIZE_PX[0] / 100, SIZE_PX[1] / 100), dpi=100)
            self._camera = _camera_axes(self._figure)
            self._plan = _plan_axes(self._figure, EDGE_OFFSET_M)
            self._map = _map_axes(self._figure, reel)
            self._trained_min = _trained_min(reel, comparison)
            self._curve = _curve_axes(self._figure, comparison, self._trained_min)
        self._moving: list[Any] = [*self._words(), *self._parts()]
        for artist in self._moving:
            artist.set_animated(True)
        self._canvas = cast("Any", FigureCanvasAgg(self._figure))
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._figure.bbox)

    def _words(self) -> Iterator[Any]:
        text = self._figure.text
        self._caption = text(0.025, 0.947, "", fontsize=15, color=_INK, weight="bold", va="center")
        self._clock = text(0.975, 0.947, "", fontsize=15, color=_INK, ha="right", va="center", family="monospace")
        self._said = text(0.025, 0.427, "", fontsize=12, color=_PALE, va="center")
        self._score = text(0.975, 0.427, "", fontsize=12, color=_PALE, ha="right", va="center")
        yield from (self._caption, self._clock, self._said, self._score)

    def _parts(self) -> Iterator[Any]:
        self._image = self._camera.imshow(np.zeros((330, 440, 3), np.uint8), extent=(0, 1, 0, 1), aspect="auto")
        self._paths = LineCollection([], linewidths=0.9, alpha=0.45)
        self._plan.add_collection(self._paths)
        (self._path,) = self._plan.plot([], [], color=_INK, linewidth=1.8)
        (self._sight,) = self._plan.plot([], [], color="#2e8b57", linewidth=1.0, linestyle=":")
        (self._arm,) = self._plan.plot([], [], color=_INK, linewidth=3.0, solid_capstyle="round")
        self._body = Circle((0, 9), RADIUS_M, facecolor="#57606a", edgecolor=_INK, linewidth=1.2, zorder=4)
        self._plan.add_patch(self._body)
        self._cells = self._map.images[0]
        (self._here,) = self._map.plot([], [], "o", color="white", markeredgecolor=_INK, markersize=9)
        (self._learned,) = self._curve.plot([], [], color=COLOURS["docked"], linewidth=2.4, drawstyle="steps-post")
        (self._now,) = self._curve.plot([], [], "o", color=COLOURS["docked"], markersize=8, markeredgecolor="white")
        yield from (self._image, self._paths, self._path, self._sight, self._arm, self._body)
        yield from (self._cells, self._here, self._learned, self._now)

    def picture(self, cue: Cue, jpeg: bytes) -> Rgb:
        """One picture, `[720, 960, 3]`."""
        self._set_words(cue)
        picture = camera_picture(jpeg, self._reel.views.get(cue.camera_ns), (440, 330))
        if picture is not None:
            self._image.set_data(picture)
        self._set_plan(cue)
        self._set_policy(cue)
        self._set_curve(cue)
        self._canvas.restore_region(self._background)
        for artist in self._moving:
            self._figure.draw_artist(artist)
        return np.asarray(self._canvas.buffer_rgba())[..., :3].copy()

    def _set_words(self, cue: Cue) -> None:
        frame = cue.moment.frame
        self._caption.set_text(cue.caption)
        self._clock.set_text(f"minute {frame.time_s / 60:4.1f}  {cue.pace:4.0f}x")
        driver = {"lc": "teacher", "random": "chance", "greedy": "policy", "servo": "servo"}.get(frame.controller, "")
        mode = frame.mode.lower() + (f", {driver} drives" if driver and frame.mode == "APPROACH" else "")
        self._said.set_text(mode)
        own = [trial for trial in self._reel.trials[: cue.moment.trials] if trial.phase == frame.phase]
        if frame.phase == "EVALUATE":
            self._score.set_text(f"docked {sum(trial.docked for trial in own)} of {len(own)}")
        else:
            self._score.set_text(f"trial {len(own) + 1}")

    def _set_plan(self, cue: Cue) -> None:
        frame = cue.moment.frame
        ended = self._reel.trials[: cue.moment.trials]
        kept = [trial for trial in ended if trial.phase == frame.phase][-PATHS:]
        self._paths.set_segments([_above(trial.path) for trial in kept])
        self._paths.set_color([COLOURS[kind_of(trial)] for trial in kept])
        running = self._reel.trials[cue.moment.trials] if cue.moment.trials < len(self._reel.trials) else None
        path = _above(_driven(running, frame.time_s)) if running is not None else []
        self._path.set_data(*(zip(*path, strict=True) if path else ((), ())))
        x, y = -frame.y_m, frame.x_m
        nose = (x - GRIPPER_M * math.sin(frame.heading_rad), y + GRIPPER_M * math.cos(frame.heading_rad))
        self._body.center = (x, y)
        self._arm.set_data((x, nose[0]), (y, nose[1]))
        self._sight.set_data((x, 0.0), (y, 0.0))

    def _set_policy(self, cue: Cue) -> None:
        frame = cue.moment.frame
        index = bisect_right(self._reel.policies, frame.time_s, key=lambda entry: entry[0])
        if index:
            self._cells.set_data(_cells(self._reel.policies[index - 1][1]))
        self._here.set_data((math.degrees(frame.alpha_rad),), (math.degrees(frame.beta_rad),))

    def _set_curve(self, cue: Cue) -> None:
        minutes = min(cue.moment.frame.time_s / 60, self._trained_min)
        points = [(0.0, 0.0), *(point for point in self._comparison.alone if point[0] <= minutes)]
        points.append((minutes, points[-1][1]))
        self._learned.set_data(*zip(*points, strict=True))
        self._now.set_data((minutes,), (points[-1][1],))


def _camera_axes(figure: Any) -> Axes:
    axes: Axes = figure.add_axes((0.025, 0.455, 440 / 960, 330 / 720))
    axes.set(xlim=(0, 1), ylim=(0, 1))
    axes.axis("off")
    return axes


def _plan_axes(figure: Any, edge_offset_m: float) -> Axes:
    axes: Axes = figure.add_axes((0.545, 0.455, 0.43, 330 / 720))
    draw_table(axes, edge_offset_m)
    axes.set(xlim=(-1.75, 1.75), ylim=(-2.45, 0.25), aspect="equal", xticks=(), yticks=())
    for kind, colour in COLOURS.items():
        axes.plot([], [], color=colour, label=kind)
    axes.legend(loc="lower center", ncols=3, frameon=False, columnspacing=1.2, handlelength=1.4)
    for spine in axes.spines.values():
        spine.set_visible(False)
    return axes


def _map_axes(figure: Any, reel: Reel) -> Axes:
    axes: Axes = figure.add_axes((0.085, 0.075, 0.33, 0.29))
    ranges = [(policy.alpha_range_rad, policy.beta_range_rad) for _, policy in reel.policies] or [(1.4, 1.13)]
    alpha, beta = (math.degrees(angle) for angle in ranges[-1])
    axes.imshow(np.zeros((1, 1, 4), np.uint8), origin="lower", extent=(-alpha, alpha, -beta, beta), aspect="auto")
    axes.grid(visible=False)
    axes.set(xlabel="alpha: bearing of the can, deg", ylabel="beta: round the table, deg")
    axes.set_title(_map_title(reel), fontsize=11, loc="left")
    for turn, colour in zip(("left", "right"), _TURNS, strict=False):
        axes.plot([], [], "s", color=colour / 255, label=turn)
    axes.legend(
        loc="lower right", bbox_to_anchor=(1.04, 0.97), ncols=2, frameon=False, handletextpad=0.1, columnspacing=1.0
    )
    return axes


def _map_title(reel: Reel) -> str:
    speeds_mps = reel.policies[-1][1].action_v_mps if reel.policies else ()
    if any(v_mps < 0.0 for v_mps in speeds_mps):
        return "plan (pale: backwards)"
    return "plan (pale: slowly)" if len(speeds_mps) > 2 else "what it would do:"


def _trained_min(reel: Reel, comparison: Comparison) -> float:
    """Robot minutes until the end of training, or the last policy if there is none."""
    trained_s = [moment.frame.time_s for moment in reel.moments if moment.frame.phase == "TRAIN"]
    last_min = max((minutes for minutes, _ in comparison.alone), default=1.0)
    return max(trained_s[-1] / 60.0 if trained_s else 0.0, last_min)


def _curve_axes(figure: Any, comparison: Comparison, trained_min: float) -> Axes:
    axes: Axes = figure.add_axes((0.545, 0.075, 0.42, 0.29))
    axes.axhline(comparison.ceiling_percent, color=_PALE, linestyle="--", linewidth=1)
    axes.set(xlabel="robot minutes", ylim=(0, 104), xlim=(0, 1.02 * trained_min))
    axes.set_title(f"how well: % of {comparison.starts} starts. Dashed: the best possible", fontsize=11)
    return axes


def _above(path: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """World (x_m, y_m) as seen from above: x upwards, y to the left."""
    return [(-y_m, x_m) for x_m, y_m in path]


def _driven(trial: Trial, time_s: float) -> Sequence[tuple[float, float]]:
    """The part of a trial's path that lies behind the robot."""
    share = (time_s - trial.began_s) / max(trial.duration_s, 1e-9)
    return trial.path[: max(0, math.ceil(share * len(trial.path)))]


def _cells(policy: Policy) -> Rgb:
    """Colour of every cell, beta upwards; clear where nothing is known."""
    action = np.frombuffer(policy.action, np.int8)
    colours = _TURNS[action % len(_TURNS)]
    colours[action < 0] = (255, 255, 255, 0)
    return colours.reshape(policy.beta_cells, policy.alpha_cells, 4)


def write(pictures: Iterable[Rgb], durations_s: Sequence[float], file: Path) -> None:
    """Write an animated WebP that is shown over and over.

    Raises:
        OSError: the file can not be written.
    """
    first, *others = (Image.fromarray(picture) for picture in pictures)
    durations_ms = [round(1000 * stands_s) for stands_s in durations_s]
    first.save(
        file,
        "WEBP",
        save_all=True,
        append_images=others,
        duration=durations_ms,
        loop=0,
        quality=QUALITY,
        method=4,
        kmin=KEY_PICTURES[0],
        kmax=KEY_PICTURES[1],
    )


def film(reel: Reel, comparison: Comparison, script: Sequence[Cue], file: Path, told: Callable[[float], None]) -> None:
    """Draw every cue and write the film.

    Args:
        reel: the session.
        comparison: its policies on the bare plant.
        script: see `report.screenplay`.
        file: WebP to write.
        told: called with the share that is done.
    """
    images = reel.images({cue.camera_ns for cue in script})
    stage = Stage(reel, comparison)

    def pictures() -> Iterator[Rgb]:
        for index, cue in enumerate(script):
            told(index / len(script))
            yield stage.picture(cue, images.get(cue.camera_ns, b""))

    write(pictures(), [cue.stands_s for cue in script], file)
