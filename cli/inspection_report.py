"""Asking before a robot moves, and what was found: a table, the lines to paste, JSON."""

from __future__ import annotations

import json
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.table import Table

from cli import correction
from cli.correction import Correction
from cli.inspection import Result
from runtime.brought import launch_file
from runtime.params import ConfigurationError
from schemas.inspection_pb2 import Finding

_MARKS = {Finding.GOOD: "[green]right[/]", Finding.WRONG: "[red]wrong[/]", Finding.UNKNOWN: "[yellow]not known[/]"}


def load_table(launch: Path) -> dict[str, Any]:
    """The launch file as it stands; `runtime.launch.load` has found it readable."""
    return tomllib.loads(launch_file(launch).read_text(encoding="utf-8"))


def ask(prepare: str, *, yes: bool, simulated: bool) -> None:
    """Say what will move and wait for Enter.

    Raises:
        ConfigurationError: there is nobody to ask.
    """
    Console(stderr=True).print(prepare + ("\nA simulated robot stands there already." if simulated else ""))
    if yes:
        return
    if not sys.stdin.isatty():
        raise ConfigurationError("--yes must be given where nobody can press a key: the robot will move")
    sys.stderr.write("Enter = go on, Ctrl-C = leave it: ")
    sys.stderr.flush()
    try:
        answer = sys.stdin.readline()
    except KeyboardInterrupt:
        answer = ""
    if not answer:
        raise typer.Exit(1)


@dataclass
class Report:
    """All stages."""

    launch: Path
    table: dict[str, Any]
    results: Sequence[Result]
    changes: Sequence[Correction]

    @property
    def findings(self) -> list[Finding]:
        """Of all stages, in order."""
        return [finding for result in self.results for finding in result.findings]

    @property
    def good(self) -> bool:
        """Everything was looked at, and everything is right."""
        return all(r.finished for r in self.results) and all(f.verdict == Finding.GOOD for f in self.findings)

    def show(self, *, as_json: bool) -> None:
        """Print it."""
        if as_json:
            sys.stdout.write(json.dumps(self.as_table()) + "\n")
            return
        console = Console()
        shown = Table(show_header=False)
        for finding in self.findings:
            shown.add_row(finding.thing, _MARKS[finding.verdict], _measured(finding), finding.words)
        if self.findings:
            console.print(shown)
        for result in self.results:
            if not result.finished:
                console.print(f"ended early: {result.reason}; the robot rests", highlight=False, soft_wrap=True)
        if self.changes:
            console.print(f"\n{self.launch} should say:\n", highlight=False)
            console.print(correction.lines(self.table, self.changes), highlight=False, markup=False, soft_wrap=True)

    def as_table(self) -> dict[str, Any]:
        """As one JSON object."""
        return {
            "good": self.good,
            "reason": self.results[-1].reason,
            "robot_s": round(sum(result.robot_s for result in self.results), 3),
            "findings": [
                {
                    "thing": finding.thing,
                    "verdict": Finding.Verdict.Name(finding.verdict).lower(),
                    "words": finding.words,
                    "measured": finding.measured,
                    "unit": finding.unit,
                }
                for finding in self.findings
            ],
            "corrections": [change._asdict() for change in self.changes],
        }

    def write(self) -> None:
        """Put the changes into the launch file."""
        if self.changes:
            correction.write(self.launch, self.changes)
            Console(stderr=True).print(f"{self.launch}: written; check again", highlight=False)


def _measured(finding: Finding) -> str:
    return f"{finding.measured:.4g} {finding.unit}" if finding.unit else ""
