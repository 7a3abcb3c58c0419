"""The report about one session: a self-contained HTML page, readable on a phone and on paper."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from docking.score import Trial, brier, outcomes
from report import charts, html
from report.charts import Figure
from report.comparison import Comparison
from report.failures import counted
from report.session import Session, resolved
from report.verdict import tiles
from runtime.recorded_launch import number_of, specs_of

_TIMES = 6
"""Times shown of failures of one name."""
_INCIDENTS, _DAMAGE = 40, 12
_LAST_TRIALS = 40
_VIEWS = ("APPROACH", "SERVO", "GRASP", "REVERSE")


def write(session: Session, file: Path, comparison: Comparison | None = None) -> None:
    """Write the page.

    Args:
        session: from `report.session.read`.
        file: path of the page; replaced if it exists.
        comparison: the session's policies beside other controllers, if there are policies.
    """
    parts = [
        f"<h1>{escape(session.file.stem)}</h1>",
        html.note(summary(session)),
        html.tiles(tiles(session, comparison)),
        html.section("Learning", *_learning(session, comparison)),
        html.section("Docking", *_docking(session)),
        html.section("What went wrong", *_wrong(session)),
        html.section("In the shadow", *_shadow(session)),
        html.section("What was learned", *_learned(session)),
        html.section("What the robot saw", *_seen(session)),
        html.section("Latency", *_latency(session)),
        html.section("Messages", *_messages(session)),
        html.section("Configuration", *_configuration(session)),
    ]
    file.write_text(html.page(session.file.stem, parts), encoding="utf-8")


def summary(session: Session) -> str:
    """What it is, in a line."""
    state = "complete" if session.whole else "torn: the end of the file is missing"
    lost = "no message lost" if session.lost == 0 else f"{session.lost} messages lost"
    about = [f"{session.robot_s / 60:.1f} robot minutes", f"{len(session.trials)} trials", lost, f"recording {state}"]
    about += [f"{name} {session.metadata[name]}" for name in ("clock", "seed", "started") if session.metadata.get(name)]
    judge = (
        "Outcomes are judged by the simulator's ground truth, which no component reads."
        if session.knows_truth
        else "No ground truth is in the file: outcomes are what the robot itself tells."
    )
    return f"{', '.join(about)}. {judge}"


def _learning(session: Session, comparison: Comparison | None) -> Iterator[str]:
    training = session.of_phase("TRAIN")
    figures: list[Figure | str] = []
    if comparison is not None:
        note = (
            f"From {comparison.starts} seeded starts on the bare plant, without camera, noise and latency. "
            "Alone: where the policy knows nothing, the last action goes on."
        )
        curves = {
            "the policy alone": charts.held(comparison.alone, training),
            "with the teacher where it knows nothing": charts.held(comparison.curve, training),
        }
        figures.append(charts.policy_curve(curves, comparison.ceiling_percent, note))
    if training:
        figures.append(charts.training_curve(training))
    if comparison is not None:
        figures.append(html.card("Beside other controllers", html.table(comparison.rows)))
    yield html.cards(figures)
    if not figures:
        yield html.note("It did not train in this session, and no policy was published.")


def _docking(session: Session) -> Iterator[str]:
    training, evaluation = session.of_phase("TRAIN"), session.of_phase("EVALUATE")
    if not session.trials:
        yield html.note("No trial ended in this session.")
        return
    if not evaluation:
        yield html.note("There was no evaluation: no trial with the policy frozen.")
    rows = outcome_rows({"training": training, "evaluation": evaluation})
    offset_m, unit = number_of(session.launch, "edge_offset_m", 0.05), "m"
    if not session.knows_truth:
        offset_m, unit = 0.0, "camera heights"
    figures: list[Figure | str] = [html.card("What became of the trials", html.table(rows))]
    if any(trial.docked for trial in evaluation):
        figures.append(charts.times({"evaluation": evaluation}))
        if session.knows_truth:
            figures.append(charts.accuracy({"evaluation": evaluation}))
    if evaluation:
        figures.append(charts.paths(evaluation, "Paths of the evaluation", offset_m, unit))
    if training:
        title = f"Paths of the last {min(len(training), _LAST_TRIALS)} training trials"
        figures.append(charts.paths(training[-_LAST_TRIALS:], title, offset_m, unit))
    yield html.cards(figures)


def outcome_rows(groups: Mapping[str, Sequence[Trial]]) -> list[list[str]]:
    """What became of the trials: a column for each group, narrow enough for a phone."""
    rows = [["", *groups], ["trials", *(str(len(trials)) for trials in groups.values())]]
    counts = [dict(outcomes(list(trials))) for trials in groups.values()]
    rows += [[name, *(str(count[name]) for count in counts)] for name, _ in outcomes([])]
    rows.append(["mean time to dock, s", *(_mean_s(trials) for trials in groups.values())])
    if any(trial.dock_share > 0.0 for trials in groups.values() for trial in trials):
        likely = (sum(trial.dock_share >= 0.5 for trial in trials) for trials in groups.values())
        rows.append(["forecast to dock", *map(str, likely)])
        rows.append(["Brier score of that", *(_brier(trials) for trials in groups.values())])
    return rows


def _brier(trials: Sequence[Trial]) -> str:
    """A trial that only trains ends before it docks: nothing to judge a forecast by."""
    square, told = brier([trial for trial in trials if trial.phase == "EVALUATE"])
    return f"{square:.3f}" if told else "-"


def _mean_s(trials: Sequence[Trial]) -> str:
    times = [trial.duration_s for trial in trials if trial.docked]
    return f"{np.mean(times):.1f}" if times else "-"


def _wrong(session: Session) -> Iterator[str]:
    if session.failed:
        yield "<h3>Trials that failed</h3>"
        yield html.note("Named by the robot itself, from percepts, odometry and commands; at the second it rests on.")
        yield html.table(_failure_rows(session))
    yield "<h3>Machinery</h3>"
    if not session.incidents and not session.damage:
        yield html.note("Nobody died, nobody was late, nothing was refused, and base stopped the robot for no reason.")
    if session.incidents:
        yield html.table(_incident_rows(session))
    if session.damage:
        yield html.table(
            [["byte", "what can not be read"], *([str(d.offset), d.words] for d in session.damage[:_DAMAGE])]
        )


def _failure_rows(session: Session) -> list[list[str]]:
    rows = [["", "training", "evaluation", "when, s"]]
    for name in counted(session.failed):
        own = [failed for failed in session.failed if failed.name == name]
        times = [f"{failed.at_s:.0f}" for failed in own]
        phases = [str(sum(failed.phase == phase for failed in own)) for phase in ("TRAIN", "EVALUATE")]
        rows.append([name, *phases, ", ".join(times[:_TIMES]) + (" ..." if len(times) > _TIMES else "")])
    return rows


def _incident_rows(session: Session) -> list[list[str]]:
    rows = [["when, s", "who", "what", "how often"]]
    for incident in session.incidents[:_INCIDENTS]:
        until = f" to {incident.to_s:.1f}" if incident.to_s - incident.from_s >= 0.1 else ""
        rows.append([f"{incident.from_s:.1f}{until}", incident.who, incident.words, str(incident.count)])
    if len(session.incidents) > _INCIDENTS:
        rows.append(["", "", f"... and {len(session.incidents) - _INCIDENTS} more", ""])
    return rows


def _shadow(session: Session) -> Iterator[str]:
    table = session.shadow
    if not table:
        return
    if not session.beside:
        yield html.note("It never had a word to say while somebody drove.")
        return
    yield html.note(
        f"{table['frames']} frames compared; the shadow would have turned alike in "
        f"{table['agree_percent']} %, and differs by {table['mean_difference_degps']} deg/s on average."
    )
    rows = [["the longest differences", "to, s", "beta, deg", "alpha, deg", "driven, deg/s", "shadow, deg/s"]]
    rows += [[f"{value:g}" for value in row.values()] for row in table["longest_differences"]]
    yield html.cards([charts.beside(session.beside)])
    yield html.table(rows)


def _learned(session: Session) -> Iterator[str]:
    if not session.policies:
        yield html.note("No policy was published in this session.")
        return
    last = session.policies[-1][1]
    figures = [charts.policy_map(last), charts.value_map(last)]
    if session.fit.promises:
        figures.append(charts.promises(session.fit.promises))
    yield html.cards(figures)
    yield from _motion(session)


def _motion(session: Session) -> Iterator[str]:
    motion = session.fit.motion
    if motion is None:
        return
    rows = [["one second ahead", "median error", "95 %", "what moved meanwhile, median"]]
    for name, errors, moved, unit in (
        ("beta", np.degrees(motion.beta_rad), np.degrees(motion.moved[0]), "deg"),
        ("alpha", np.degrees(motion.alpha_rad), np.degrees(motion.moved[1]), "deg"),
        ("distance", 100 * motion.distance_share, 100 * motion.moved[2], "%"),
    ):
        half, most = np.percentile(errors, (50, 95))
        rows.append([name, f"{half:.2f} {unit}", f"{most:.2f} {unit}", f"{moved:.2f} {unit}"])
    yield html.note("The learned model of motion against what happened, from each percept by the commands executed:")
    yield html.table(rows)


def _seen(session: Session) -> Iterator[str]:
    views = [html.photograph(session.pictures[mode], mode.lower()) for mode in _VIEWS if session.pictures.get(mode)]
    if not views:
        yield html.note("No camera image is in the file.")
    yield html.cards(views, "small")
    if session.tracking_px:
        errors_deg = np.degrees(session.bearing_error_rad).tolist()
        yield html.cards(tracking({"frames": session.tracking_px}, {"frames": errors_deg}))


def tracking(errors_px: Mapping[str, Sequence[float]], errors_deg: Mapping[str, Sequence[float]]) -> Iterator[Figure]:
    """How well the head keeps the object in the image centre, and what that makes of the bearing."""
    yield charts.histogram("Tracking", "object from the image centre, px", errors_px, note="Of the frames that see it.")
    yield charts.histogram("Bearing", "error of the bearing, deg", errors_deg, note="Percept against the truth.")


def _latency(session: Session) -> Iterator[str]:
    if not session.hops:
        lockstep = session.launch.get("clock") == "lockstep"
        why = (
            "in lockstep time waits for every answer" if lockstep else "no journal of the camera's host is in the file"
        )
        yield html.note(f"Not measured: {why}.")
        return
    yield html.cards([charts.latency(session.hops)])
    rows = [["from", "to", "messages", "median, ms", "95 %", "99 %", "longest"]]
    for hop in session.hops:
        numbers = [f"{value:.1f}" for value in (*hop.percentiles_ms(), float(hop.ages_ms.max()))]
        rows.append([hop.topic, f"{hop.component}.{hop.port}", str(len(hop.ages_ms)), *numbers])
    yield html.folded(f"Age of what each of {len(session.hops)} inputs was handed", html.table(rows))


def _messages(session: Session) -> Iterator[str]:
    lost = sum(topic.lost for topic in session.topics)
    yield html.note(f"{session.messages} messages; {lost or 'none'} lost." if session.messages else "There is none.")
    rows = [["topic", "messages", "per second", "kB", "gaps", "lost", "runs"]]
    for name in sorted({topic.topic for topic in session.topics}):
        own = [topic for topic in session.topics if topic.topic == name]
        count, size, gaps, gone = (
            sum(getattr(topic, what) for topic in own) for what in ("count", "bytes", "gaps", "lost")
        )
        hz = f"{count / session.robot_s:.2f}" if session.robot_s > 0 else "-"
        rows.append([name, str(count), hz, f"{size / 1000:.0f}", str(gaps), str(gone), str(len(own))])
    yield html.folded("Rates and losses of every topic", html.table(rows)) if len(rows) > 1 else ""


def _configuration(session: Session) -> Iterator[str]:
    launch = session.launch
    yield html.note(", ".join(f"{key} {value}" for key, value in _facts(session)))
    for name, params in components_of(launch).items():
        words = ", ".join(f"{key} = {shown(value)}" for key, value in params.items())
        yield html.folded(name, f"<p>{escape(words) or 'no parameters'}</p>")
    yield html.folded("The resolved launch file", f"<pre>{escape(resolved(session))}</pre>")


def _facts(session: Session) -> Iterable[tuple[str, str]]:
    for key in ("realm", "clock", "seed"):
        if session.metadata.get(key):
            yield key, session.metadata[key]
    try:
        machine = json.loads(session.metadata.get("fingerprint", "{}"))
    except ValueError:
        machine = {}
    if isinstance(machine, dict):
        for key, value in sorted(machine.items()):
            yield str(key), shown(value)


def components_of(launch: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Parameters of the task and of each component, from a resolved launch file of whatever release."""
    found: dict[str, Mapping[str, Any]] = {}
    for spec in specs_of(launch):
        task = spec["params"].get("task")
        if isinstance(task, dict):
            found.setdefault("task", task)
        found[str(spec.get("name"))] = {key: value for key, value in spec["params"].items() if key != "task"}
    return found


def shown(value: Any) -> str:
    """A parameter's value, briefly."""
    text = f"{value:.6g}" if isinstance(value, float) else value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def numbers(session: Session) -> Mapping[str, int]:
    """Trials of the evaluation by outcome, for the command's summary."""
    return dict(outcomes(session.of_phase("EVALUATE")))
