"""The charts of a report."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from docking.score import DOCKED_M, Trial
from report.chart import Axis, Chart, Key, Point, span
from report.fit import Promise
from report.latency import Hop
from report.shadow import Beside
from schemas.policy_pb2 import Policy

OUTCOMES = {"docked": "good", "reached": "a", "failed": "bad"}
"""What became of a trial -> its mark, in every chart."""
_WINDOW = 20
_PATH_POINTS = 60
_FEW = 30
"""Trials that are also shown one by one."""
_LINES = ("a", "b", "c", "d")
_LEFT_RGB, _RIGHT_RGB = (0x1F, 0x77, 0xB4), (0xF2, 0x9E, 0x38)
_LINE_OF_SIGHT = ("foxglove.CompressedImage", "berth.View", "berth.Percept", "berth.Drive")
"""From the camera to the wheels."""
_BINS = 48
_CURVE_HEIGHT, _MAP_HEIGHT, _ROW_HEIGHT = 210.0, 250.0, 44.0


class Figure(NamedTuple):
    """A chart with its title, its legend and a sentence on how to read it."""

    title: str
    chart: Chart
    keys: Sequence[Key] = ()
    note: str = ""


def kind_of(trial: Trial) -> str:
    """Key of `OUTCOMES`."""
    return "docked" if trial.docked else "reached" if trial.reached else "failed"


def policy_curve(curves: Mapping[str, Sequence[Point]], ceiling_percent: float, note: str) -> Figure:
    """Share of the starts from which the policy of each minute reaches the goal cell; the first curve on top."""
    last_min = max((x for curve in curves.values() for x, _ in curve), default=1.0)
    chart = Chart(Axis(0, max(last_min, 1.0), "robot minutes"), Axis(0, 100, "goal cell reached, %"), _CURVE_HEIGHT)
    chart.level(ceiling_percent, "e dashed")
    named = list(zip(_LINES, curves.items(), strict=False))
    for mark, (_, curve) in reversed(named):
        chart.line(curve, mark)
        chart.dots(curve, mark, 2.2)
    keys = [Key(mark, words) for mark, (words, _) in named]
    return Figure("The policy, minute by minute", chart, [*keys, Key("e dashed", "best that is possible")], note)


def held(curve: Sequence[Point], trials: Sequence[Trial]) -> Sequence[Point]:
    """A curve of policies, the last of which stays in force until the last of these trials ends."""
    until_min = max((trial.ended_s / 60 for trial in trials), default=0.0)
    return [*curve, (until_min, curve[-1][1])] if until_min > curve[-1][0] else curve


def training_curve(trials: Sequence[Trial]) -> Figure:
    """Share of the training trials that reached the goal cell, by who drove."""
    groups = {
        _DRIVERS.get(controller, controller): [trial for trial in trials if trial.controller == controller]
        for controller in sorted({trial.controller for trial in trials})
    }
    return training_of(groups)


def training_of(groups: Mapping[str, Sequence[Trial]]) -> Figure:
    """As `training_curve`, of any groups of trials."""
    last_min = max((trial.ended_s / 60 for trials in groups.values() for trial in trials), default=1.0)
    chart = Chart(Axis(0, max(last_min, 1.0), "robot minutes"), Axis(0, 100, "goal cell reached, %"), _CURVE_HEIGHT)
    keys = []
    for mark, (name, trials) in zip(_LINES, groups.items(), strict=False):
        chart.line(moving_share(trials), mark)
        chart.dots(moving_share(trials) if len(trials) <= _FEW else [], mark, 2.2)
        keys.append(Key(mark, f"{name} ({len(trials)} trials)"))
    note = f"Of the last {_WINDOW} trials. Random actions and the teacher only collect experience: they need not rise."
    return Figure("Training trials", chart, keys, note)


_DRIVERS = {"lc": "the teacher", "random": "random actions", "greedy": "the policy"}


def moving_share(trials: Sequence[Trial]) -> list[Point]:
    """(robot minutes, percent of the last trials that reached the goal cell) at the end of each."""
    return [
        (
            trial.ended_s / 60,
            100.0 * float(np.mean([t.reached for t in trials[max(0, index - _WINDOW + 1) : index + 1]])),
        )
        for index, trial in enumerate(trials)
    ]


def histogram(
    title: str, label: str, groups: Mapping[str, Sequence[float]], limit: float | None = None, note: str = ""
) -> Figure:
    """Distribution of one quantity, for one group or for several; `limit` is drawn as a line."""
    known = {name: np.array([v for v in values if math.isfinite(v)]) for name, values in groups.items()}
    everything = np.concatenate([*known.values(), np.zeros(1)])
    top = max(float(np.percentile(everything, 99)) * 1.15, (limit or 0.0) * 1.25, 1e-6)
    edges = np.linspace(0.0, top, 25)
    shares = {
        name: 100.0 * np.histogram(np.minimum(values, top), edges)[0] / max(len(values), 1)
        for name, values in known.items()
    }
    high = span(float(share.max()) for share in shares.values())[1]
    chart = Chart(Axis(0, top, label), Axis(0, high, "share, %"), _CURVE_HEIGHT)
    for number, (mark, share) in enumerate(zip(_LINES, shares.values(), strict=False)):
        chart.bars(edges.tolist(), share.tolist(), mark, (number, len(shares)))
    if limit is not None:
        chart.upright(limit, "bad dashed")
    keys = [Key(mark, f"{name}{_median(values)}") for mark, (name, values) in zip(_LINES, known.items(), strict=False)]
    return Figure(title, chart, keys, note)


def _median(values: NDArray[np.float64]) -> str:
    if not values.size:
        return " (none)"
    return f": median {np.median(values):.3g}, 95 % below {np.percentile(values, 95):.3g} ({len(values)})"


def accuracy(groups: Mapping[str, Sequence[Trial]]) -> Figure:
    """Where the gripper stood when it was called, of each trial that came so far."""
    errors_mm = {name: [1e3 * trial.gripper_error_m for trial in trials] for name, trials in groups.items()}
    note = f"Dashed: what counts as docked, {1e3 * DOCKED_M:.0f} mm. Larger ones are in the last bar."
    return histogram("Accuracy", "gripper from its pose, mm", errors_mm, 1e3 * DOCKED_M, note)


def times(groups: Mapping[str, Sequence[Trial]]) -> Figure:
    """How long docking took."""
    taken_s = {name: [trial.duration_s for trial in trials if trial.docked] for name, trials in groups.items()}
    return histogram("Time to dock", "s", taken_s, note="Trials that docked, from the start to the end of the trial.")


def paths(trials: Sequence[Trial], title: str, edge_offset_m: float, unit: str) -> Figure:
    """Paths of the axle from above; the object at the origin, the table ahead."""
    far = _extent(trials)
    chart = Chart(Axis(-0.72 * far, 0.72 * far, unit), Axis(-far, 0.2 * far, unit), 42 + 302 * 1.2 / 1.44)
    chart.box((-far, -edge_offset_m), (far, far), "table")
    chart.level(-edge_offset_m, "edge")
    for kind in reversed(OUTCOMES):
        for trial in trials:
            if kind_of(trial) == kind and trial.path:
                points = [(-y, x) for x, y in _thinned(trial.path)]
                chart.line(points, f"{OUTCOMES[kind]} thin")
                (chart.crosses if kind == "failed" else chart.dots)(points[:1], OUTCOMES[kind], 2.2)
    chart.dots([(0.0, 0.0)], "object", 4.5)
    counts = {kind: sum(kind_of(trial) == kind for trial in trials) for kind in OUTCOMES}
    keys = [Key(mark, f"{kind} {counts[kind]}") for kind, mark in OUTCOMES.items()]
    return Figure(title, chart, keys, "From above; the table is at the top. A mark is where a trial began.")


def _extent(trials: Sequence[Trial]) -> float:
    reach = [max(abs(x), abs(y) / 0.72) for trial in trials for x, y in trial.path[:: max(1, len(trial.path) // 20)]]
    reach = [r for r in reach if math.isfinite(r)]
    return min(max(1.1 * float(np.percentile(reach, 99)), 0.5), 100.0) if reach else 2.5


def _thinned(path: Sequence[Point]) -> Sequence[Point]:
    return [*path[:: max(1, math.ceil(len(path) / _PATH_POINTS))], path[-1]]


def policy_map(policy: Policy) -> Figure:
    """Action of every cell."""
    action = np.frombuffer(policy.action, np.int8)
    turns, speeds = np.array(policy.action_omega_radps), np.array(policy.action_v_mps)
    colours = np.array([_action_rgba(v, omega, speeds) for v, omega in zip(speeds, turns, strict=True)], np.uint8)
    known = np.where(action >= 0, action, 0)
    rgba = np.where((action >= 0)[:, None], colours[np.minimum(known, len(colours) - 1)], np.uint8(0)).astype(np.uint8)
    percent = 100.0 * float(np.mean(action >= 0))
    keys = [Key("left", "turn left"), Key("right", "turn right")]
    if len(set(speeds.tolist())) > 1:
        keys.append(Key("slow", "lighter: slower or backwards"))
    return _cells(policy, rgba, f"The policy: {percent:.0f} % of the cells are known", keys, "Empty: nothing is known.")


def value_map(policy: Policy) -> Figure:
    """Value of every cell."""
    value = np.array(policy.value, float)
    known = (np.frombuffer(policy.action, np.int8) >= 0) & np.isfinite(value)
    low, high = (float(value[known].min()), float(value[known].max())) if known.any() else (0.0, 1.0)
    shade = np.clip(np.where(known, (value - low) / max(high - low, 1e-9), 0.0) * 255.0, 0, 255).astype(np.uint8)
    bgr = cv2.applyColorMap(shade.reshape(-1, 1), cv2.COLORMAP_VIRIDIS).reshape(-1, 3)
    rgba = np.where(known[:, None], np.hstack([bgr[:, ::-1], np.full((len(bgr), 1), 255, np.uint8)]), np.uint8(0))
    keys = [Key("yellow", f"high: {high:.0f}"), Key("violet", f"low: {low:.0f}")]
    note = "The goal's reward less one for each sampling period to go, where it arrives."
    return _cells(policy, rgba.astype(np.uint8), "The value of each cell", keys, note)


def _action_rgba(v_mps: float, omega_radps: float, speeds: NDArray[np.float64]) -> tuple[int, int, int, int]:
    red, green, blue = _LEFT_RGB if omega_radps > 0 else _RIGHT_RGB
    strength = 1.0 if v_mps >= speeds.max() - 1e-9 else 0.55 if v_mps > 0 else 0.3
    mixed = [round(255 - strength * (255 - part)) for part in (red, green, blue)]
    return mixed[0], mixed[1], mixed[2], 255


def _cells(policy: Policy, rgba: NDArray[np.uint8], title: str, keys: Sequence[Key], note: str) -> Figure:
    beta, alpha = math.degrees(policy.beta_range_rad), math.degrees(policy.alpha_range_rad)
    chart = Chart(Axis(-alpha, alpha, "alpha, deg"), Axis(-beta, beta, "beta, deg"), _MAP_HEIGHT, grid=False)
    picture = rgba.reshape(policy.beta_cells, policy.alpha_cells, 4)[::-1, :, [2, 1, 0, 3]]
    chart.image(cv2.imencode(".png", np.ascontiguousarray(picture))[1].tobytes())
    chart.crosses([(0.0, 0.0)], "ink")
    return Figure(
        title, chart, keys, f"{note} alpha is the bearing of the object, beta its direction; cross: the goal."
    )


def promises(found: Sequence[Promise]) -> Figure:
    """What the policy promised when it began, against what it took."""
    kept = [(p.promised_s, p.took_s) for p in found if math.isfinite(p.promised_s) and math.isfinite(p.took_s)]
    broken = [p.promised_s for p in found if math.isfinite(p.promised_s) and not math.isfinite(p.took_s)]
    top = span([value for pair in kept for value in pair] + broken, 10.0)[1]
    chart = Chart(Axis(0, top, "promised, s"), Axis(0, top, "what it took, s"), _MAP_HEIGHT)
    chart.line([(0, 0), (top, top)], "e dashed")
    chart.dots(kept, "a")
    chart.crosses([(promised, 0.97 * top) for promised in broken], "bad")
    error_s = float(np.median([abs(a - b) for a, b in kept])) if kept else math.nan
    where = "pick-up, as the pilot forecast it" if any(p.is_forecast for p in found) else "goal cell, by its value"
    note = f"Time to the {where}. Median error {error_s:.1f} s." if kept else "No promise was kept."
    keys = [Key("a", f"promised and reached ({len(kept)})"), Key("bad", f"promised, not reached ({len(broken)})")]
    return Figure("What the policy promised, and what happened", chart, keys, note)


def beside(frames: Sequence[Beside]) -> Figure:
    """Where in (beta, alpha) a shadow would have turned as the robot did, and where not."""
    across, up = ([math.degrees(getattr(f, name)) for f in frames] for name in ("alpha_rad", "beta_rad"))
    wide, high = (max(5.0, 1.05 * max((abs(v) for v in values), default=5.0)) for values in (across, up))
    chart = Chart(Axis(-wide, wide, "alpha, deg"), Axis(-high, high, "beta, deg"), _MAP_HEIGHT)
    rows = list(zip(across, up, (f.agrees for f in frames), strict=True))
    step = max(1, len(rows) // 1500)
    chart.dots([(x, y) for x, y, agrees in rows[::step] if agrees], "a", 1.6)
    chart.crosses([(x, y) for x, y, agrees in rows[::step] if not agrees], "bad", 2.0)
    alike = sum(f.agrees for f in frames)
    return Figure(
        "Where they agree", chart, [Key("a", f"alike ({alike})"), Key("bad", f"otherwise ({len(frames) - alike})")]
    )


def latency(hops: Sequence[Hop]) -> Figure:
    """From exposure to `handle`, a histogram for each hop from the camera to the wheels."""
    rows = [hop for hop in hops if hop.schema in _LINE_OF_SIGHT] or list(hops[:8])
    oldest_ms = max(float(hop.ages_ms.max()) for hop in rows)
    youngest_ms = max(min(float(np.percentile(hop.ages_ms, 1)) for hop in rows), 1e-2)
    axis = Axis(
        10 ** math.floor(math.log10(youngest_ms)), 10 ** math.ceil(math.log10(max(oldest_ms, 1.0))), "ms", log=True
    )
    chart = Chart(axis, Axis(0, len(rows)), 42 + _ROW_HEIGHT * len(rows), rows=False)
    edges = np.geomspace(axis.low, axis.high, _BINS + 1)
    for number, hop in enumerate(reversed(rows)):
        share = np.histogram(hop.ages_ms, edges)[0]
        tall = 0.55 * share / max(share.max(), 1)
        for low, high, value in zip(edges, edges[1:], tall, strict=False):
            if value > 0:
                chart.box((float(low), number), (float(high), number + max(float(value), 0.02)), "a")
        half, _, nearly_all = hop.percentiles_ms()
        chart.text(axis.low, number + 0.68, f" {hop.topic} \N{RIGHTWARDS ARROW} {hop.component}", "start")
        chart.text(axis.high, number + 0.68, f"{half:.3g} / {nearly_all:.3g} ms", "end")
    return Figure("From exposure to each component", chart, (), "Right: median / 99 %. Each histogram by itself.")
