"""`berth check [LAUNCH]`: the machine and, with a launch file, the contract of every component."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from runtime.check import Finding
from runtime.check import check as check_contract
from runtime.fingerprint import fingerprint
from runtime.launch import load

LAUNCH = Annotated[Path | None, typer.Argument(help="Launch file whose components are checked.")]
DURATION = Annotated[float, typer.Option(help="Session seconds to run.", min=1.0)]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def check(launch: LAUNCH = None, duration: DURATION = 15.0, as_json: JSON = False) -> None:
    """Check this machine and a launch file's components. Example: berth check launch/sim.toml."""
    findings = _machine()
    if launch is not None:
        findings += check_contract(load(launch, clock="lockstep"), duration)
    kept = all(finding.kept for finding in findings)
    if as_json:
        rows = [finding._asdict() for finding in findings]
        sys.stdout.write(json.dumps({"kept": kept, "findings": rows, "fingerprint": fingerprint()}) + "\n")
    else:
        _print(findings)
    raise typer.Exit(0 if kept else 1)


def _machine() -> list[Finding]:
    cores = os.cpu_count() or 1
    return [
        Finding("machine", "Python 3.11 or newer", sys.version_info >= (3, 11), sys.version.split()[0]),
        Finding("machine", "two processor cores or more", cores >= 2, f"{cores} cores"),
        Finding("machine", "recordings/ can be written", os.access(".", os.W_OK), str(Path.cwd())),
    ]


def _print(findings: list[Finding]) -> None:
    table = Table(show_header=False)
    for finding in findings:
        mark = "[green]kept[/]" if finding.kept else "[red]broken[/]"
        table.add_row(finding.component, finding.rule, mark, finding.detail)
    Console().print(table)
