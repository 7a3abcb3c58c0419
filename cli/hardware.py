"""`berth check hardware LAUNCH`: every sign, unit and beam of a robot, found by small motions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from cli.correction import Correction, corrected, corrections
from cli.doing import QUIET, doing
from cli.inspection import Result, inspected, of_run, run_stage
from cli.inspection_report import Report, ask, load_table
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.system import System

STAGES = {
    "facing": (
        "Pan and tilt turn by 4 deg, the robot turns by 5 deg and drives 4 cm, each to and fro.\n"
        "Put the robot 2 m before the object and facing it, with free floor around it, the head at its zero (switch it "
        "off and on)."
    ),
    "fingertips": (
        "The robot creeps 4.5 cm forwards and back; the fingers close on the object and open; the lift goes up 2 cm "
        "and down.\n"
        "Put the robot so that the object stands 2 to 3 cm before the finger tips, the lift down, the fingers open and "
        "nothing between them."
    ),
}
"""Stage -> what moves, and what has to be prepared."""

LAUNCH = Annotated[Path, typer.Argument(help="Launch file of the robot.")]
STAGE = Annotated[str, typer.Option(help="both, facing (head and wheels) or fingertips (lift, fingers, beams).")]
SET = Annotated[list[str] | None, typer.Option("--set", help="As for `berth run`.")]
CLOCK = Annotated[str, typer.Option(help="As for `berth run`.")]
IN_PROCESS = Annotated[bool, typer.Option("--in-process", help="A simulated robot in one process, repeatable.")]
SEED = Annotated[int | None, typer.Option(help="Seed of the session.")]
YES = Annotated[bool, typer.Option("--yes", help="Everything is prepared: move without asking.")]
WRITE = Annotated[bool, typer.Option("--write", help="Put the corrections into the launch file.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def hardware(
    launch: LAUNCH,
    stage: STAGE = "both",
    overrides: SET = None,
    clock: CLOCK = "",
    in_process: IN_PROCESS = False,
    seed: SEED = None,
    yes: YES = False,
    write: WRITE = False,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Find wrong signs, units and beams by small motions. Example: berth check hardware launch/sim.toml --yes."""
    if stage not in {"both", *STAGES}:
        raise ConfigurationError(f"--stage must be one of both, {', '.join(STAGES)}; got {stage!r}")
    system = load(launch, overrides or (), clock="lockstep" if in_process else clock, seed=seed)
    table = load_table(launch)
    stages = tuple(STAGES) if stage == "both" else (stage,)
    for each in stages:
        inspected(system, each)  # say what is wrong before anybody is asked to prepare anything
    results: list[Result] = []
    changes: list[Correction] = []
    for each in stages:
        ask(STAGES[each], yes=yes, simulated=of_run(system, "components.simulator") is not None)
        with doing(f"checking: {each}", quiet=quiet or as_json):
            result, found = checked(system, changes, each, in_process=in_process)
        results.append(result)
        changes += found
        if not result.finished:
            break
    report = Report(launch, table, results, changes)
    report.show(as_json=as_json)
    if write:
        report.write()
    raise typer.Exit(0 if report.good else 1)


def checked(
    system: System, changes: Sequence[Correction], stage: str, *, in_process: bool
) -> tuple[Result, list[Correction]]:
    """One stage with what was found before put right, and what it changes."""
    right = corrected(system, changes)
    result = run_stage(inspected(right, stage), in_process=in_process)
    return result, corrections(right, result.findings)
