"""`berth replay FILE --component C`: run one component over a recording, off the bus, and compare what it says."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.doing import QUIET, doing
from cli.exit_codes import DIFFERENT, GOOD, LOSSY
from runtime.one_thread import limit_threads
from runtime.recording import Recording
from runtime.replay import Report
from runtime.replay import replay as run_again
from runtime.said import writer_of

FILE = Annotated[Path, typer.Argument(help="Recording (MCAP).")]
COMPONENT = Annotated[str, typer.Option("--component", "-c", help="Name of the component in the recording.")]
CHECK = Annotated[bool, typer.Option("--check", help="Compare with what it said; exit code 1 if anything differs.")]
SET = Annotated[list[str] | None, typer.Option("--set", help="COMPONENT.PARAM=VALUE, task.KEY=VALUE: what changes?")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Recording to write: what it says now.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def replay(
    file: FILE,
    component: COMPONENT,
    check: CHECK = False,
    overrides: SET = None,
    output: OUTPUT = None,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Run a component once more over a recording; exit code 3 if what can be compared is the same, not all is there.

    Example: berth replay recordings/sim.mcap --component tracker --check.
    """
    limit_threads()
    began_s = time.monotonic()
    with doing(f"running {component} again", quiet=quiet or as_json):
        report = _replayed(Recording(file), component, overrides or [], output, compare=check or bool(overrides))
    table = _table(report, time.monotonic() - began_s)
    if as_json:
        sys.stdout.write(json.dumps(table) + "\n")
    else:
        sys.stdout.write("".join(f"{line}\n" for line in _lines(report, table, check or bool(overrides))))
    raise typer.Exit(_exit_code(report, check=check, asked_for_changes=bool(overrides)))


def _replayed(
    recording: Recording, component: str, overrides: list[str], output: Path | None, *, compare: bool
) -> Report:
    if output is None:
        return run_again(recording, component, overrides, compare=compare)
    with writer_of(recording, component, overrides, output) as write:
        return run_again(recording, component, overrides, compare=compare, tell=write)


def _exit_code(report: Report, *, check: bool, asked_for_changes: bool) -> int:
    if any(outcome.raised for outcome in report.runs) or (check and report.differs):
        return DIFFERENT
    if asked_for_changes and not check:
        return GOOD
    return LOSSY if report.is_lossy else GOOD


def _table(report: Report, wall_s: float) -> dict[str, Any]:
    return {
        "component": report.component,
        "events": report.events,
        "outputs": report.outputs,
        **{name: report.count(name) for name in ("identical", "different", "unpaired", "beyond")},
        "differences": [f"{difference}" for difference in report.first],
        "runs": [
            {"run": f"{outcome.run:016x}", "events": outcome.events, "end": outcome.words, "raised": outcome.raised}
            for outcome in report.runs
        ],
        "notes": report.notes,
        "same_machine": not report.other_machine,
        "wall_s": round(wall_s, 3),
    }


def _lines(report: Report, table: dict[str, Any], compared: bool) -> Iterator[str]:
    said = ", ".join(f"{key} {count}" for key, count in report.outputs.items()) or "nothing"
    yield f"{report.component}: {report.events} events in {table['wall_s']:.1f} s; said: {said}"
    yield from report.notes
    for outcome in report.runs:
        if outcome.raised:
            yield f"raised {outcome.raised}"
        elif outcome.words:
            yield outcome.words
    if compared:
        yield from _verdict(report)


def _verdict(report: Report) -> Iterator[str]:
    if report.other_machine:
        yield "recorded on another machine or with other libraries: real numbers are compared with a tolerance of 1e-6"
    identical, different = report.count("identical"), report.count("different")
    if not identical + different and not any(comparison.has_record for comparison in report.comparisons):
        held = f"the recording holds nothing that {report.component} said"
        yield f"nothing to compare: {held}" if report.outputs else f"identical: {held}, and it says nothing"
        return
    yield from (str(difference) for difference in report.first)
    missing = [
        f"{report.count(name)} {words}"
        for name, words in (("unpaired", "not in the recording"), ("beyond", "recorded after that"))
        if report.count(name)
    ]
    if different:
        changed = [c.changed for c in report.comparisons]
        keys = sorted({key for counts in changed for key in counts})
        where = ", ".join(f"{key} {sum(counts.get(key, 0) for counts in changed)}" for key in keys)
        yield f"different: {different} of {identical + different} outputs: {where}"
    else:
        yield f"identical: {identical} of {identical} outputs"
    if missing:
        yield "not compared: " + ", ".join(missing)
