"""`berth stop`: stop a running system."""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from typing import Annotated

import typer

from runtime.runfile import Run, find, running

REALM = Annotated[str, typer.Option(help="Which system, if more than one runs.")]
ALL = Annotated[bool, typer.Option("--all", help="Every system of this user on this host.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
_TIMEOUT_S = 5.0
_LOOK_S = 0.02


def stop(realm: REALM = "", every: ALL = False, as_json: JSON = False) -> None:
    """Stop a system cleanly and wait until it is down. Example: berth stop."""
    runs = running() if every else [find(realm)]
    for run in runs:
        os.kill(run.pid, signal.SIGTERM)
    still = _wait(runs)
    stopped = [run.realm for run in runs if run not in still]
    if as_json:
        sys.stdout.write(json.dumps({"stopped": stopped, "still_running": [run.realm for run in still]}) + "\n")
    else:
        for name in stopped:
            sys.stdout.write(f"stopped {name}\n")
        for run in still:
            sys.stderr.write(f"berth: {run.realm} still runs after {_TIMEOUT_S:.0f} s (pid {run.pid})\n")
    raise typer.Exit(1 if still else 0)


def _wait(runs: list[Run]) -> list[Run]:
    """Those that still run after the time-out."""
    deadline_s = time.monotonic() + _TIMEOUT_S
    while (still := [run for run in runs if run in running()]) and time.monotonic() < deadline_s:
        time.sleep(_LOOK_S)
    return still
