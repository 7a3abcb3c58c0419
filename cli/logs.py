"""`berth logs`: what the processes have said."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, BinaryIO

import typer

from runtime.params import ConfigurationError
from runtime.runfile import newest_logs, running

COMPONENTS = Annotated[list[str] | None, typer.Argument(help="Only these components.")]
FOLLOW = Annotated[bool, typer.Option("-f", "--follow", help="Go on as long as the system runs.")]
REALM = Annotated[str, typer.Option(help="Which system; default: the newest.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object a line.")]
_LOOK_S = 0.2


def logs(components: COMPONENTS = None, follow: FOLLOW = False, realm: REALM = "", as_json: JSON = False) -> None:
    """Show the processes' output, also of a system that has ended. Example: berth logs -f learner."""
    directory = newest_logs(realm)
    names = components or sorted(path.stem for path in directory.glob("*.log"))
    for name in names:
        if not (directory / f"{name}.log").exists():
            raise ConfigurationError(f"{directory}: component {name} must have a log there")
    streams = {name: (directory / f"{name}.log").open("rb") for name in names}
    try:
        _show(streams, as_json=as_json)
        while follow and _runs(directory):
            time.sleep(_LOOK_S)
            _show(streams, as_json=as_json)
    except KeyboardInterrupt:
        return
    finally:
        for stream in streams.values():
            stream.close()


def _runs(directory: Path) -> bool:
    return any(run.directory == str(directory) for run in running())


def _show(streams: Mapping[str, BinaryIO], *, as_json: bool) -> None:
    width = max((len(name) for name in streams), default=0)
    for name, stream in streams.items():
        for raw in stream.readlines():
            line = raw.decode(errors="replace").rstrip("\n")
            text = json.dumps({"component": name, "line": line}) if as_json else f"{name:{width}} | {line}"
            sys.stdout.write(text + "\n")
    sys.stdout.flush()
