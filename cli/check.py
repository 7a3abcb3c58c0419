"""`berth check [LAUNCH]`: the machine and, with a launch file, the contract of every component.

`berth check hardware LAUNCH` lets the robot move a little and checks how it is wired: `cli.hardware`.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
import typer.core
from rich.console import Console
from rich.table import Table

from cli.doing import QUIET, doing
from cli.hardware import hardware
from cli.stand_in import devices, has_world, simulated
from runtime.check import Finding
from runtime.check import check as check_contract
from runtime.fingerprint import fingerprint
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.system import System

LAUNCH = Annotated[Path | None, typer.Argument(help="Launch file whose components are checked.")]
DURATION = Annotated[float, typer.Option(help="Session seconds to run.", min=1.0)]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


CONTRACT = "contract"
"""The verb that stands for a launch file alone."""


class OrContract(typer.core.TyperGroup):
    """A word that is none of its verbs is the launch file of the first one."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Name the verb that was left out."""
        named = bool(args) and (args[0] in self.commands or args[0] in ctx.help_option_names)
        return super().parse_args(ctx, args if named else [CONTRACT, *args])


check = typer.Typer(cls=OrContract, help="Check this machine, a launch file's components, or a robot.",
                    rich_markup_mode=None, add_completion=False)  # fmt: skip
check.command("hardware")(hardware)


@check.command(CONTRACT)
def contract(launch: LAUNCH = None, duration: DURATION = 15.0, quiet: QUIET = False, as_json: JSON = False) -> None:
    """Check this machine and a launch file's components. Example: berth check launch/sim.toml."""
    findings = _machine()
    if launch is not None:
        system = load(launch, clock="lockstep")
        with doing("running every component", quiet=quiet or as_json):
            findings += _tried(system, duration)
    kept = all(finding.kept for finding in findings)
    if as_json:
        rows = [finding._asdict() for finding in findings]
        sys.stdout.write(json.dumps({"kept": kept, "findings": rows, "fingerprint": fingerprint()}) + "\n")
    else:
        _print(findings)
    raise typer.Exit(0 if kept else 1)


def _tried(system: System, duration_s: float) -> list[Finding]:
    """Every component; the simulator plays the devices of a robot that has them."""
    absent = devices(system)
    if not absent or has_world(system):
        return check_contract(system, duration_s)
    left_out = Finding("devices", "not tried: need a robot", kept=True, detail=", ".join(absent))
    try:
        stand_in = simulated(system)
    except ConfigurationError as error:
        words = f"wires and parameters are right; nothing was run: {error}"
        return [left_out, Finding("components", "not tried: need a world", kept=True, detail=words)]
    return [left_out, *check_contract(stand_in, duration_s)]


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
