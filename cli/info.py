"""`berth info FILE`: what is in a recording, and whether it is all there."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from docking.score import outcomes
from report.session import Session, read
from runtime.recording import Recording, Topic

LOSSY = 3
"""Exit code of a recording with holes or a torn end."""
FILE = Annotated[Path, typer.Argument(help="Recording (MCAP).")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def info(file: FILE, as_json: JSON = False) -> None:
    """Describe a recording; exit code 3 if something is missing. Example: berth info recordings/sim.mcap."""
    session, topics = read(file), Recording(file).topics()
    numbers = _numbers(session)
    if as_json:
        sys.stdout.write(json.dumps({**numbers, "topics": [vars(topic) for topic in topics]}) + "\n")
    else:
        _print(numbers, topics)
    raise typer.Exit(0 if session.whole and not session.lost else LOSSY)


def _numbers(session: Session) -> dict[str, object]:
    return {
        "file": str(session.file),
        "state": "complete" if session.whole else "torn",
        "robot_s": round(session.robot_s, 3),
        "trials": len(session.trials),
        **dict(outcomes(session.trials)),
        "collisions": session.collisions,
        "messages": session.messages,
        "lost": session.lost,
        **{key: session.metadata.get(key, "") for key in ("realm", "clock", "seed", "started")},
    }


def _print(numbers: dict[str, object], topics: list[Topic]) -> None:
    console = Console()
    for name, value in numbers.items():
        console.print(f"{name:12} {value}", highlight=False)
    table = Table("topic", "schema", "run", "messages", "bytes", "lost")
    for topic in topics:
        row = (topic.topic, topic.schema, f"{topic.run:016x}", str(topic.count), str(topic.bytes), str(topic.lost))
        table.add_row(*row)
    console.print(table)
