"""`berth graph LAUNCH`: a system as a picture, in text or as Mermaid."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from runtime.launch import load
from runtime.system import System, ports_of
from runtime.wiring import Wire, wires

LAUNCH = Annotated[Path, typer.Argument(help="Launch file.")]
MERMAID = Annotated[bool, typer.Option("--mermaid", help="A Mermaid flow chart, as Markdown renders it.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def graph(launch: LAUNCH, mermaid: MERMAID = False, as_json: JSON = False) -> None:
    """Show who sends what to whom. Example: berth graph launch/sim.toml --mermaid."""
    system = load(launch)
    found = wires(system)
    if as_json:
        text = json.dumps({"components": [c.name for c in system.components], "wires": [w._asdict() for w in found]})
    else:
        text = _mermaid(system, found) if mermaid else _text(system, found)
    sys.stdout.write(text + "\n")


def _mermaid(system: System, found: list[Wire]) -> str:
    lines = ["flowchart LR"]
    lines += [f"  {spec.name}" for spec in system.components]
    lines += [f"  {wire.source} -- {wire.key} --> {wire.target}" for wire in found]
    return "\n".join(lines)


def _text(system: System, found: list[Wire]) -> str:
    lines = []
    for spec in system.components:
        lines.append(f"{spec.name}  ({spec.run}, on {spec.host}, restart {spec.restart})")
        ports = ports_of(spec.run).OUTPUTS
        for port, key in spec.outputs.items():
            readers = [f"{wire.target}.{wire.input}" for wire in found if wire.key == key]
            schema = ports[port].schema.DESCRIPTOR.full_name
            lines.append(f"  {key:20} {schema:28} -> {', '.join(readers) or 'recorded only'}")
    return "\n".join(lines)
