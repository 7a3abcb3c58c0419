"""`berth experiment NAME`: the paper's tables and figures, the ceiling, our own comparisons."""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.doing import QUIET
from runtime.params import ConfigurationError

if TYPE_CHECKING:
    from experiments.campaign import Outcome

NAME = Annotated[
    str,
    typer.Argument(
        help="ceiling, table2, curves, trajectories, schools, docking-law, ablation, paper-robot, "
        "minutes, minutes-two-speeds, minutes-reverse, minutes-changed, minutes-mid-session, fleet, faults.",
        show_default=False,
    ),
]
SEEDS = Annotated[str | None, typer.Option(help="A count (20) or a list (3,5,9).")]
MINUTES = Annotated[float | None, typer.Option(help="Robot minutes to learn.")]
NOISE = Annotated[float, typer.Option(help="Deviation of each step's speed and turn rate, as a share of them.")]
FOLDER = Annotated[Path, typer.Option("-o", "--output", help="Folder for CSV and pictures; also what is resumed.")]
BACKEND = Annotated[str, typer.Option(help="joblib's: loky, threading, dask ($DASK_SCHEDULER_ADDRESS) or ray.")]
JOBS = Annotated[int, typer.Option("--jobs", "-j", help="Processes; -1 = one for each core.")]
POLICIES = Annotated[Path | None, typer.Option(help="Folder to which learned controllers are exported.")]
GOAL = Annotated[str, typer.Option(help="cell = the paper's goal cell; dock = gripper within 2 cm and 4 deg.")]
TURN_RATE = Annotated[float | None, typer.Option(help="Turn rate of the actions, deg/s.")]
SPEED = Annotated[float | None, typer.Option(help="Speed of the actions, m/s.")]
DELAY = Annotated[int, typer.Option(help="Sampling periods from a percept to its command.")]
GRIPPER = Annotated[float | None, typer.Option(help="Gripper ahead of the axle, m, for --goal dock.")]
NEURAL = Annotated[bool, typer.Option("--neural", help="schools: a neural learner too; needs the extra `neural`.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
_WIDTH = 160
"""Columns of the table in a file or a pipe."""


def experiment(
    name: NAME,
    seeds: SEEDS = None,
    minutes: MINUTES = None,
    plant_noise: NOISE = 0.0,
    output: FOLDER = Path("results"),
    backend: BACKEND = "loky",
    jobs: JOBS = -1,
    policies: POLICIES = None,
    goal: GOAL = "cell",
    turn_rate_dps: TURN_RATE = None,
    speed_mps: SPEED = None,
    delay_samples: DELAY = 0,
    gripper_m: GRIPPER = None,
    neural: NEURAL = False,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Run an experiment, or what is left of it: tables, pictures. Example: berth experiment ceiling -o results."""
    _check(minutes, plant_noise, goal, turn_rate_dps, speed_mps, delay_samples, gripper_m)
    if neural and name != "schools":
        raise ConfigurationError(f"--neural belongs to schools; got experiment {name!r}")
    from rich.console import Console  # noqa: PLC0415  heavy: imported when called

    from docking.angles import DEG  # noqa: PLC0415
    from experiments.campaign import Options, run_campaign, seeds_of  # noqa: PLC0415
    from experiments.registry import load  # noqa: PLC0415

    options = Options(
        seeds=None if seeds is None else seeds_of(seeds),
        minutes=minutes,
        plant_noise=plant_noise,
        goal=goal,
        policies=None if policies is None else str(policies),
        turn_rate_radps=None if turn_rate_dps is None else turn_rate_dps * DEG,
        speed_mps=speed_mps,
        delay_samples=delay_samples,
        gripper_m=gripper_m,
        neural=neural,
    )
    console, began = None if quiet else Console(stderr=True), time.monotonic()
    outcome = run_campaign(load(name), options, output, backend=backend, workers=jobs, console=console)
    if as_json:
        sys.stdout.write(json.dumps(_numbers(name, outcome, time.monotonic() - began)) + "\n")
    else:
        _print(outcome)


def _check(
    minutes: float | None,
    plant_noise: float,
    goal: str,
    turn_rate_dps: float | None,
    speed_mps: float | None,
    delay_samples: int,
    gripper_m: float | None,
) -> None:
    """Refuse a number out of its range, by the option's name."""
    positive = {
        "--minutes": minutes,
        "--turn-rate-dps": turn_rate_dps,
        "--speed-mps": speed_mps,
        "--gripper-m": gripper_m,
    }
    for option, value in positive.items():
        if value is not None and not 0.0 < value < float("inf"):
            raise ConfigurationError(f"{option} must be > 0 and finite; got {value}")
    if not 0.0 <= plant_noise < 1.0:
        raise ConfigurationError(f"--plant-noise must be in [0, 1); got {plant_noise}")
    if not 0 <= delay_samples <= 100:
        raise ConfigurationError(f"--delay-samples must be 0 to 100; got {delay_samples}")
    if goal not in {"cell", "dock"}:
        raise ConfigurationError(f"--goal must be cell or dock; got {goal!r}")


def _numbers(name: str, outcome: Outcome, wall_s: float) -> dict[str, object]:
    return {
        "experiment": name,
        "csv": str(outcome.csv),
        "pictures": [str(path) for path in outcome.pictures],
        "resumed_jobs": outcome.resumed_jobs,
        "wall_s": round(wall_s, 3),
        "rows": [asdict(row) for row in outcome.rows],
    }


def _print(outcome: Outcome) -> None:
    from rich.console import Console  # noqa: PLC0415
    from rich.table import Table  # noqa: PLC0415

    form = outcome.form
    console, (header, *lines) = Console(width=None if sys.stdout.isatty() else _WIDTH), form.summary(outcome.rows)
    table = Table(*header)
    for line in lines:
        table.add_row(*line)
    console.print(table)
    console.print(form.note, highlight=False)
    for path in (outcome.csv, *outcome.pictures):
        console.print(str(path), highlight=False)
