"""The report: one self-contained HTML page."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path

import numpy as np

from docking.score import Trial, outcomes
from report import pictures
from report.comparison import Comparison
from report.failures import counted
from report.session import Session, resolved

_STYLE = """
body{font:15px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#1f2328}
h1{font-size:1.5rem;margin-bottom:0}h2{font-size:1.1rem;margin-top:2rem}
img{max-width:100%;height:auto}img.half{width:49%;min-width:20rem}table{border-collapse:collapse;margin:.5rem 0}
td,th{border-bottom:1px solid #d0d7de;padding:.25rem .8rem .25rem 0;text-align:left}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
p.note{color:#57606a}pre{background:#f6f8fa;padding:.8rem;overflow-x:auto;font-size:12px}
@media(prefers-color-scheme:dark){body{background:#fff}}@media print{pre{display:none}}
"""

_TIMES = 12
"""Times shown of failures of one name."""


def write(session: Session, file: Path, comparison: Comparison | None = None) -> None:
    """Write the page.

    Args:
        session: from `report.session.read`.
        file: path of the page; replaced if it exists.
        comparison: the session's policies beside other controllers, if there are policies.
    """
    file.write_text(_page(session, comparison), encoding="utf-8")


def _page(session: Session, comparison: Comparison | None) -> str:
    training = [trial for trial in session.trials if trial.phase == "TRAIN"]
    evaluation = [trial for trial in session.trials if trial.phase == "EVALUATE"]
    parts = [
        f"<h1>{escape(session.file.stem)}</h1>",
        f"<p class=note>{escape(_summary(session))}</p>",
        *_section("What became of the trials", _table(_outcome_rows(training, evaluation))),
    ]
    if session.failed:
        parts += _section("Why trials failed", _failures(session))
    if session.shadow:
        parts += _section("In the shadow", _shadow(session))
    if training:
        parts += _section("Training", _img(pictures.learning_curve(training)))
    if comparison is not None:
        parts += _compared(comparison)
    parts += _paths(session, training, evaluation)
    if session.policies:
        parts += _section("What was learned", _img(pictures.policy_maps(session.policies[-1][1])))
    if session.pictures:
        parts += _section("What the robot saw", _img(pictures.camera_strip(session.pictures)))
    if session.tracking_px:
        parts += _section("Tracking", _img(pictures.tracking(session.tracking_px, session.bearing_error_rad)))
    parts += _section("Messages", _table(_message_rows(session)))
    parts += _section("Configuration", f"<pre>{escape(resolved(session))}</pre>")
    return (
        "<!doctype html><html lang=en><meta charset=utf-8>"
        "<meta name=viewport content='width=device-width,initial-scale=1'>"
        f"<title>{escape(session.file.stem)}</title><style>{_STYLE}</style><body>{''.join(parts)}</body></html>"
    )


def _failures(session: Session) -> str:
    note = "Named by the robot itself, from percepts, odometry and commands; at the session second it rests on."
    rows = [["", "trials", "when, s"]]
    for name, count in counted(session.failed).items():
        times = [f"{failed.at_s:.1f}" for failed in session.failed if failed.name == name]
        rows.append([name, str(count), ", ".join(times[:_TIMES]) + (", ..." if len(times) > _TIMES else "")])
    return f"<p class=note>{note}</p>{_table(rows)}"


def _shadow(session: Session) -> str:
    table = session.shadow
    if not session.beside:
        return "<p class=note>It never had a word to say while somebody drove.</p>"
    note = (
        f"<p class=note>{table['frames']} frames compared; the shadow would have turned alike in "
        f"{table['agree_percent']} %, and differs by {table['mean_difference_degps']} deg/s on average.</p>"
    )
    rows = [["the longest differences", "to, s", "beta, deg", "alpha, deg", "driven, deg/s", "shadow, deg/s"]]
    rows += [[f"{value:g}" for value in row.values()] for row in table["longest_differences"]]
    return note + _img(pictures.beside(session.beside)) + _table(rows)


def _compared(comparison: Comparison) -> Iterable[str]:
    note = (
        f"<p class=note>On the bare plant, without camera, noise and latency, from {comparison.starts} seeded starts: "
        "|beta| up to 45 deg, |alpha| up to 30 deg, 1.5 to 2 m. What the camera makes of it is in the trials above.</p>"
    )
    curve = _img(pictures.controllability(comparison.curve, comparison.ceiling_percent))
    return _section("The frozen policy, minute by minute", note + curve + _table(comparison.rows))


def _summary(session: Session) -> str:
    state = "complete" if session.whole else "torn: the end of the file is missing"
    lost = "no message lost" if session.lost == 0 else f"{session.lost} messages lost"
    started = session.metadata.get("started", "")
    return (
        f"{session.robot_s / 60:.1f} robot minutes, {len(session.trials)} trials, {session.collisions} collisions, "
        f"{session.messages} messages, {lost}, recording {state}. Started {started}. "
        "Outcomes are judged by the simulator's ground truth, which no component reads."
    )


def _paths(session: Session, training: list[Trial], evaluation: list[Trial]) -> Iterable[str]:
    offset_m = session.launch_number("simulator", "edge_offset_m", 0.05)
    views = []
    if training:
        views.append(pictures.plan_view(training[-40:], offset_m, "the last 40 training trials"))
    if evaluation:
        views.append(pictures.plan_view(evaluation, offset_m, "evaluation, frozen policy"))
    return _section("Paths, from above", "".join(_img(view, "half") for view in views))


def _outcome_rows(training: list[Trial], evaluation: list[Trial]) -> list[list[str]]:
    names = [name for name, _ in outcomes([])]
    rows = [["", "trials", *names, "mean time to dock, s"]]
    for label, trials in (("training", training), ("evaluation", evaluation)):
        times = [trial.duration_s for trial in trials if trial.docked]
        mean = f"{np.mean(times):.1f}" if times else "-"
        rows.append([label, str(len(trials)), *(str(count) for _, count in outcomes(trials)), mean])
    return rows


def _message_rows(session: Session) -> list[list[str]]:
    seconds = max(session.robot_s, 1e-9)
    return [["topic", "messages", "per robot second"]] + [
        [topic, str(count), f"{count / seconds:.2f}"] for topic, count in sorted(session.counts.items())
    ]


def _section(title: str, body: str) -> list[str]:
    return [f"<h2>{escape(title)}</h2>", body]


def _img(png: bytes, kind: str = "whole") -> str:
    return f"<img class={kind} alt='' src='data:image/png;base64,{base64.b64encode(png).decode()}'>"


def _table(rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th{_number(i)}>{escape(cell)}</th>" for i, cell in enumerate(rows[0]))
    body = "".join(
        "<tr>" + "".join(f"<td{_number(i)}>{escape(cell)}</td>" for i, cell in enumerate(row)) + "</tr>"
        for row in rows[1:]
    )
    return f"<table><tr>{head}</tr>{body}</table>"


def _number(column: int) -> str:
    return " class=n" if column else ""


def numbers(session: Session) -> Mapping[str, int]:
    """Trials of the evaluation by outcome, for the command's summary."""
    return dict(outcomes([trial for trial in session.trials if trial.phase == "EVALUATE"]))
