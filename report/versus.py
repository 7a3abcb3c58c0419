"""Two sessions side by side: what was set differently, and what came of it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from docking.score import Trial
from experiments.sequential import wilson
from report import charts, html
from report.comparison import Comparison
from report.incidents import Incident
from report.page import outcome_rows, shown, summary, tracking
from report.session import Session
from report.verdict import Tile, judged, percent_range
from runtime.recorded_launch import number_of, specs_of

_DIFFERENCES = 60
"""Lines of configuration shown."""
_NAMES = ("A", "B")


class Side(NamedTuple):
    """One of the two."""

    session: Session
    comparison: Comparison | None


def write(sides: tuple[Side, Side], file: Path) -> None:
    """Write the page; it replaces a file of that name."""
    title = " against ".join(side.session.file.stem for side in sides)
    about = [
        f"<p><b>{name}</b> {escape(str(side.session.file))}<br><span class=mute>{escape(summary(side.session))}</span>"
        for name, side in zip(_NAMES, sides, strict=True)
    ]
    parts = [
        f"<h1>{escape(title)}</h1>",
        *about,
        html.tiles([_better(sides)]),
        html.section("What was set differently", *_configuration(sides)),
        html.section("Docking", *_docking(sides)),
        html.section("Learning", *_learning(sides)),
        html.section("Tracking", *_tracking(sides)),
        html.section("Losses and faults", html.table(_machinery(sides))),
    ]
    file.write_text(html.page(title, parts), encoding="utf-8")


def numbers(sides: tuple[Side, Side]) -> dict[str, Any]:
    """What the page says, by name."""
    found: dict[str, Any] = {"different": dict(differences(*(side.session for side in sides)))}
    for name, side in zip(_NAMES, sides, strict=True):
        phase, trials = judged(side.session)
        docked = sum(trial.docked for trial in trials)
        found[name] = {"file": str(side.session.file), "phase": phase, "trials": len(trials), "docked": docked}
    low, high = _difference(sides)
    found["difference_percent"] = None if math.isnan(low) else [round(100 * low, 1), round(100 * high, 1)]
    return found


def newcombe(first: tuple[int, int], second: tuple[int, int]) -> tuple[float, float]:
    """95 % interval of the second success rate less the first (Newcombe 1998, method 10), from (successes, trials).

    Without any trial on one side nothing is known: NaN.
    """
    if not first[1] or not second[1]:
        return math.nan, math.nan
    (p, (p_low, p_high)), (q, (q_low, q_high)) = ((s / n, wilson(s, n)) for s, n in (first, second))
    return q - p - math.hypot(q - q_low, p_high - p), q - p + math.hypot(q_high - q, p - p_low)


def differences(first: Session, second: Session) -> list[tuple[str, tuple[str, str]]]:
    """(name, (value in the first, value in the second)) of everything that was set differently."""
    left, right = (dict(_flat(_settings(session))) for session in (first, second))
    names = dict.fromkeys([*left, *right])
    return [(n, (left.get(n, "-"), right.get(n, "-"))) for n in names if left.get(n) != right.get(n)]


def _settings(session: Session) -> dict[str, Any]:
    """The launch file by component, and the machine; not when and where it was recorded."""
    launch = session.launch
    found = {key: value for key, value in launch.items() if key not in {"components", "realm"}}
    for spec in specs_of(launch):
        found[str(spec.get("name"))] = {key: value for key, value in spec.items() if key not in {"name", "seed"}}
    found.pop("recorder", None)  # the file's own name and how it is written
    try:
        found["machine"] = json.loads(session.metadata.get("fingerprint", "{}"))
    except ValueError:
        found["machine"] = {}
    return found


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, str]]:
    """Leaves of nested tables, named as `--set` names them."""
    if isinstance(value, Mapping) and value:
        for key, below in value.items():
            part = "" if key == "params" else f".{key}"
            yield from _flat(below, (name + part).lstrip("."))
    else:
        yield name, shown(value)


def _configuration(sides: tuple[Side, Side]) -> Iterator[str]:
    found = _merged(differences(sides[0].session, sides[1].session))
    if not found:
        yield html.note("Nothing: the same system, seed and machine.")
        return
    rows = [["", *_NAMES], *([name, *values] for name, values in found[:_DIFFERENCES])]
    yield html.table(rows)
    if len(found) > _DIFFERENCES:
        yield html.note(f"... and {len(found) - _DIFFERENCES} more.")


def _merged(found: Sequence[tuple[str, tuple[str, str]]]) -> list[tuple[str, tuple[str, str]]]:
    """A parameter of the task stands in every component that has a task: it is one difference."""
    rows: dict[str, tuple[str, str]] = {}
    for name, values in found:
        _, dot, field = name.partition(".task.")
        rows.setdefault(f"task.{field}" if dot else name, values)
    return list(rows.items())


def _difference(sides: tuple[Side, Side]) -> tuple[float, float]:
    counts = [(sum(t.docked for t in trials), len(trials)) for _, trials in (judged(side.session) for side in sides)]
    return newcombe(counts[0], counts[1])


def _better(sides: tuple[Side, Side]) -> Tile:
    low, high = _difference(sides)
    question = "Does B dock more often than A?"
    if math.isnan(low):
        return Tile(question, "Not known", "none", "One of them has no trial to judge.")
    words = (
        f"The difference of the success rates is within {100 * low:+.0f} to {100 * high:+.0f} points (95 %, Newcombe)."
    )
    if low > 0:
        return Tile(question, "Yes", "good", words)
    if high < 0:
        return Tile(question, "No, less often", "bad", words)
    return Tile(question, "Not shown", "none", f"{words} These trials do not tell them apart.")


def _by_name(sides: tuple[Side, Side], phase: str = "") -> dict[str, Sequence[Trial]]:
    trials = [side.session.of_phase(phase) if phase else judged(side.session)[1] for side in sides]
    return dict(zip(_NAMES, trials, strict=True))


def _docking(sides: tuple[Side, Side]) -> Iterator[str]:
    groups = _by_name(sides)
    rows = outcome_rows(groups)
    phases = [judged(side.session)[0] for side in sides]
    docked = [(sum(trial.docked for trial in trials), len(trials)) for trials in groups.values()]
    rows.insert(1, ["judged by the", *phases])
    likely = [percent_range(*count) if count[1] else "-" for count in docked]
    rows.append(["docked, 95 % interval", *likely])
    figures: list[charts.Figure | str] = [html.card("What became of the trials", html.table(rows))]
    if any(trial.docked for trials in groups.values() for trial in trials):
        figures.append(charts.times(groups))
    if all(side.session.knows_truth for side in sides):
        figures.append(charts.accuracy(groups))
    for name, side in zip(_NAMES, sides, strict=True):
        trials = groups[name]
        if trials:
            unit = "m" if side.session.knows_truth else "camera heights"
            offset_m = number_of(side.session.launch, "edge_offset_m", 0.05)
            figures.append(charts.paths(trials, f"Paths of {name}", offset_m, unit))
    yield html.cards(figures)


def _learning(sides: tuple[Side, Side]) -> Iterator[str]:
    curves = {
        name: charts.held(side.comparison.alone, side.session.of_phase("TRAIN"))
        for name, side in zip(_NAMES, sides, strict=True)
        if side.comparison is not None
    }
    figures = []
    best = max((side.comparison.ceiling_percent for side in sides if side.comparison is not None), default=0.0)
    if curves:
        figures.append(charts.policy_curve(curves, best, "The policy alone, on the bare plant, from the same starts."))
    training = {name: trials for name, trials in _by_name(sides, "TRAIN").items() if trials}
    if training:
        figures.append(charts.training_of(training))
    yield html.cards(figures)


def _tracking(sides: tuple[Side, Side]) -> Iterator[str]:
    sessions = [side.session for side in sides]
    if not any(session.tracking_px for session in sessions):
        yield html.note("Not measured: no ground truth is in the files.")
        return
    pixels = [session.tracking_px for session in sessions]
    degrees = [np.degrees(session.bearing_error_rad).tolist() for session in sessions]
    yield html.cards(
        tracking(*(dict(zip(_NAMES, values, strict=True)) for values in (pixels, degrees))),
    )


def _machinery(sides: tuple[Side, Side]) -> list[list[str]]:
    sessions = [side.session for side in sides]
    rows = [["", *_NAMES]]
    rows.append(["robot minutes", *(f"{session.robot_s / 60:.1f}" for session in sessions)])
    rows.append(["messages", *(str(session.messages) for session in sessions)])
    rows.append(["lost", *(str(session.lost) for session in sessions)])
    rows.append(["file", *("complete" if session.whole else "torn" for session in sessions)])
    kinds = dict.fromkeys(incident.kind for session in sessions for incident in session.incidents)
    rows += [[kind, *(_count(session.incidents, kind) for session in sessions)] for kind in kinds]
    return rows


def _count(incidents: Sequence[Incident], kind: str) -> str:
    return str(sum(incident.count for incident in incidents if incident.kind == kind))
