"""`berth tune head LAUNCH`: latencies of camera and encoders, pixels per degree, lag, gains, from steps of the head."""

from __future__ import annotations

import typer

from cli.correction import corrections
from cli.doing import QUIET, doing
from cli.hardware import CLOCK, IN_PROCESS, JSON, LAUNCH, SEED, SET, WRITE, YES
from cli.inspection import inspected, of_run, run_stage
from cli.inspection_report import Report, ask, load_table
from runtime.launch import load

PREPARE = (
    "Pan steps by 4 deg to both sides and tilt by 6 deg, for half a minute; the wheels stand.\n"
    "Put the robot 2 m before the object and facing it, the head at its zero (switch it off and on)."
)

tune = typer.Typer(
    help="Measure what a parameter should be.", no_args_is_help=True, rich_markup_mode=None, add_completion=False
)


@tune.callback()
def _tune() -> None:
    """One verb alone would not be named."""


@tune.command("head")
def head(
    launch: LAUNCH,
    overrides: SET = None,
    clock: CLOCK = "",
    in_process: IN_PROCESS = False,
    seed: SEED = None,
    yes: YES = False,
    write: WRITE = False,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Measure latencies, pixels per degree, lag and gains. Example: berth tune head launch/sim.toml --yes."""
    system = load(launch, overrides or (), clock="lockstep" if in_process else clock, seed=seed)
    table, made = load_table(launch), inspected(system, "head")
    ask(PREPARE, yes=yes, simulated=of_run(system, "components.simulator") is not None)
    with doing("measuring the head", quiet=quiet or as_json):
        result = run_stage(made, in_process=in_process)
    report = Report(launch, table, [result], corrections(system, result.findings))
    report.show(as_json=as_json)
    if write:
        report.write()
    raise typer.Exit(0 if report.good else 1)
