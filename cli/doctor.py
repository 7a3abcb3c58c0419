"""`berth doctor FILE`: verify a recording."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from cli.doing import QUIET, doing
from cli.exit_codes import DIFFERENT, GOOD, LOSSY
from runtime.findings import Examination
from runtime.recording import Recording

FILE = Annotated[Path, typer.Argument(help="Recording (MCAP).")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
_LOSSES = {"file", "sequence", "journal"}
"""Kinds of finding that say: something is missing. The others say: something is wrong."""


def doctor(file: FILE, quiet: QUIET = False, as_json: JSON = False) -> None:
    """Verify a recording's order, schemas, sequences, journals; exit code 3: something is missing, 1: it is wrong.

    Example: berth doctor recordings/sim.mcap.
    """
    examination = Examination(Recording(file))
    with doing(f"examining {file}", quiet=quiet or as_json):
        findings = examination.run()
    if as_json:
        table = {"file": str(file), "messages": examination.messages, "findings": [f._asdict() for f in findings]}
        sys.stdout.write(json.dumps(table) + "\n")
    else:
        lines = [f"{finding.kind}: {finding.words}" for finding in findings] or ["nothing is wrong"]
        sys.stdout.write("".join(f"{line}\n" for line in [f"{file}: {examination.messages} messages", *lines]))
    raise typer.Exit(_code({finding.kind for finding in findings}))


def _code(kinds: set[str]) -> int:
    if kinds - _LOSSES:
        return DIFFERENT
    return LOSSY if kinds else GOOD
