"""`berth ps`: what runs on this host."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from typing import Annotated

import typer

from runtime.params import ConfigurationError
from runtime.runfile import Run, running

JSON = Annotated[bool, typer.Option("--json", help="One JSON list on standard output.")]


def ps(as_json: JSON = False) -> None:
    """Show the systems that run on this host; which of their components are up. Example: berth ps."""
    runs = [(run, _present(run)) for run in running()]
    if as_json:
        sys.stdout.write(json.dumps([{**asdict(run), "up": up} for run, up in runs]) + "\n")
        return
    for run, up in runs:
        down = [name for name in run.components if name not in up]
        sys.stdout.write(f"{run.realm}  pid {run.pid}  since {run.started}  {run.launch}\n")
        sys.stdout.write(f"  up: {', '.join(up) or '-'}\n" + (f"  not up: {', '.join(down)}\n" if down else ""))
    if not runs:
        sys.stdout.write("nothing is running\n")


def _present(run: Run) -> list[str]:
    from cli.observer import present  # noqa: PLC0415  (nothing running, nothing to load)

    try:
        return present(run)
    except ConfigurationError:
        return []  # it ended between two looks
