"""`berth report FILE`: one HTML page about a session."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

FILE = Annotated[Path, typer.Argument(help="Recording (MCAP).")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Page to write; default: beside the recording.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def report(file: FILE, output: OUTPUT = None, as_json: JSON = False) -> None:
    """Write a page with the learning curve, paths, policy and tracking. Example: berth report recordings/sim.mcap."""
    page, numbers = write_report(file, output)
    text = json.dumps({"report": str(page), **numbers}) if as_json else str(page)
    sys.stdout.write(text + "\n")


def write_report(file: Path, output: Path | None = None) -> tuple[Path, dict[str, int]]:
    """Read the session and write its page; matplotlib and numba are imported only here.

    Raises:
        ConfigurationError: the file is no session of ours.
    """
    from report.comparison import compare  # noqa: PLC0415
    from report.page import numbers, write  # noqa: PLC0415
    from report.session import read  # noqa: PLC0415

    page = output or file.with_suffix(".html")
    session = read(file)
    comparison = compare(session.policies, session.launch.get("task", {})) if session.policies else None
    write(session, page, comparison)
    return page, dict(numbers(session))
