"""`berth info FILE`: what is in a recording, and whether it is all there."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from cli.doing import QUIET, doing
from cli.exit_codes import GOOD, LOSSY
from docking.score import outcomes
from report.failures import counted
from report.session import Session, read
from runtime.recording import Topic

_COMPLETE = "complete"
_WIDTH = 140
"""Of the table where standard output is no terminal; no name is cut off in it."""
FILE = Annotated[Path, typer.Argument(help="Recording (MCAP).")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def info(file: FILE, quiet: QUIET = False, as_json: JSON = False) -> None:
    """Describe a recording; exit code 3 if something is missing. Example: berth info recordings/sim.mcap."""
    with doing(f"reading {file}", quiet=quiet or as_json):
        session = read(file)
        found = numbers(session)
    if as_json:
        failed = [failure.table() for failure in session.failed]
        sys.stdout.write(
            json.dumps({**found, "failed": failed, "topics": [vars(topic) for topic in session.topics]}) + "\n"
        )
    else:
        _print(found, session.topics)
    raise typer.Exit(GOOD if found["state"] == _COMPLETE else LOSSY)


def numbers(session: Session) -> dict[str, object]:
    """What is told of a session, by name."""
    counts = dict(outcomes(session.trials))
    succeeded = sum(trial.reached or trial.picked for trial in session.trials)
    return {
        "file": str(session.file),
        "state": _state(session),
        "robot_s": round(session.robot_s, 3),
        "robot_minutes": round(session.robot_s / 60, 2),
        "trials": len(session.trials),
        "success_percent": round(100 * succeeded / len(session.trials), 1) if session.trials else None,
        **counts,
        "collisions": session.collisions,
        "failures": counted(session.failed),
        **({"shadow": dict(session.shadow)} if session.shadow else {}),
        "messages": session.messages,
        "bytes": session.file.stat().st_size,
        "lost": session.lost,
        **{key: session.metadata.get(key, "") for key in ("realm", "clock", "seed", "started")},
    }


def _state(session: Session) -> str:
    """Complete, or what is missing."""
    words = [f"byte {fault.offset}: {fault.words}" for fault in session.damage]
    if not session.whole:
        words.insert(0, "torn")
    words += [f"{topic.lost} lost on {topic.topic}" for topic in session.topics if topic.lost]
    return "; ".join(words) or _COMPLETE


def _print(found: dict[str, object], topics: list[Topic]) -> None:
    console = Console(soft_wrap=True, width=None if sys.stdout.isatty() else _WIDTH)
    for name, value in found.items():
        if isinstance(value, dict):
            value = ", ".join(f"{key} {number}" for key, number in value.items() if not isinstance(number, list))  # noqa: PLW2901
        console.print(f"{name:16} {'-' if value is None else value}", highlight=False)
    table = Table("topic", "schema", "run")
    for head in ("messages", "Hz", "bytes", "gaps", "lost"):
        table.add_column(head, justify="right")
    for topic in topics:
        row = (topic.count, f"{topic.hz:.2f}", topic.bytes, topic.gaps, topic.lost)
        table.add_row(topic.topic, topic.schema, f"{topic.run:016x}", *map(str, row))
    console.print(table)
