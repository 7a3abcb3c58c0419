"""`berth relearn FILE...`: learn again from recordings, with the same parameters or others, without the robot."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Annotated

import typer

from cli.doing import QUIET, doing
from cli.exit_codes import DIFFERENT, GOOD, LOSSY
from runtime.one_thread import limit_threads
from runtime.params import ConfigurationError

FILES = Annotated[list[Path], typer.Argument(help="Recordings (MCAP), learned from in turn.")]
COMPONENT = Annotated[str, typer.Option("--component", "-c", help="Name of the learner in the recordings.")]
SET = Annotated[list[str] | None, typer.Option("--set", help="learner.PARAM=VALUE, also task.KEY=VALUE.")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Policy file to write.")]
NO_COMPARISON = Annotated[bool, typer.Option("--no-comparison", help="Only learn.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def relearn(
    files: FILES,
    component: COMPONENT = "learner",
    overrides: SET = None,
    output: OUTPUT = None,
    no_comparison: NO_COMPARISON = False,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Learn again from recordings; exit code 1: the same parameters give other tables, 3: something is missing.

    Example: berth relearn recordings/sim.mcap --set learner.sweeps=4 -o better.policy
    berth run launch/sim.toml --set pilot.policy=better.policy --set pilot.train_s=0
    """
    began_s = time.monotonic()
    limit_threads()
    from cli.lessons import learn  # noqa: PLC0415  (numpy and numba: after the number of threads is settled)

    if output is not None and output.exists():
        raise ConfigurationError(f"-o {output}: must not exist yet")
    with doing("learning again", quiet=quiet or as_json):
        report = learn(files, component, overrides or (), compare=not no_comparison)
    if output is not None:
        _write(output, report.policy())
    if as_json:
        sys.stdout.write(json.dumps({"wall_s": round(time.monotonic() - began_s, 3), **report.table()}) + "\n")
    else:
        sys.stdout.write("".join(f"{line}\n" for line in report.lines()))
    raise typer.Exit(DIFFERENT if report.same is False else LOSSY if report.is_lossy else GOOD)


def _write(output: Path, policy: bytes) -> None:
    try:
        output.write_bytes(policy)
    except OSError as error:
        raise ConfigurationError(f"-o {output}: can not be written: {error.strerror}") from None
