"""`berth compare A B`: trials of two policies in turn on one robot, until it is decided which is better."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from cli.policies import controller_and_file, pilot_of
from cli.progress import Progress
from cli.run import CLOCK, IN_PROCESS, JSON, QUIET, RECORD, SEED, SET, check_recording, execute
from cli.session import Watch, now, recording_name
from report.duel import Duel
from runtime.launch import load
from runtime.link import Link
from runtime.params import ConfigurationError
from runtime.system import System
from schemas.trial_pb2 import Trial

FIRST = Annotated[str, typer.Argument(metavar="A", help="A policy file, or lc: the linear law.")]
SECOND = Annotated[str, typer.Argument(metavar="B", help="As A.")]
LAUNCH = Annotated[Path, typer.Option(help="Launch file of the robot.")]
PAIRS = Annotated[int, typer.Option(help="Most pairs of trials.", min=1)]
ALPHA = Annotated[float, typer.Option(help="Largest probability of naming a better one of two that are equal.")]
RESET = Annotated[str, typer.Option(help="place: the simulator puts the robot; reverse: it drives back itself.")]


class Referee(Watch):
    """Ends the session once the evidence suffices."""

    def __init__(self, progress: Progress, duel: Duel) -> None:
        super().__init__(progress)
        self._duel = duel

    def take(self, message: Any, capture_ns: int) -> None:
        """A `Trial` or a `Truth` from the bus."""
        super().take(message, capture_ns)
        if isinstance(message, Trial) and not self.over:
            self._duel.take(message, capture_ns)
            self.over = "decided" if self._duel.winner else ""


def compare(
    first: FIRST,
    second: SECOND,
    launch: LAUNCH = Path("launch/sim.toml"),
    pairs: PAIRS = 100,
    alpha: ALPHA = 0.05,
    reset: RESET = "",
    overrides: SET = None,
    record: RECORD = None,
    clock: CLOCK = "",
    in_process: IN_PROCESS = False,
    seed: SEED = None,
    as_json: JSON = False,
    quiet: QUIET = False,
) -> None:
    """Find out which of two policies docks more often. Example: berth compare better.policy lc --in-process."""
    if not 0.0 < alpha < 1.0:
        raise ConfigurationError(f"--alpha must be between 0 and 1; got {alpha}")
    started = now()
    own = _overrides(launch, first, second, pairs, reset)
    system = load(
        launch,
        [*own, *(overrides or ())],
        clock="lockstep" if in_process else clock,
        seed=seed,
        recording=record or recording_name(launch.with_stem("compare"), started),
    )
    _check(system)
    check_recording(system)
    duel = Duel(alpha)
    with Progress(f"berth compare {first} {second}", quiet=quiet or as_json) as progress:
        failed, reason = execute(system, Referee(progress, duel), started, None, Link(), in_process=in_process)
    table = duel.table()
    table["a"] = {"policy": first, **table["a"]}
    table["b"] = {"policy": second, **table["b"]}
    table |= {"recording": str(system.recording or ""), "exit_reason": reason}
    sys.stdout.write(json.dumps(table) + "\n") if as_json else _print(table)
    raise typer.Exit(1 if failed else 0)


def _overrides(launch: Path, first: str, second: str, pairs: int, reset: str) -> list[str]:
    """What a comparison changes in the pilot's parameters."""
    system = load(launch)
    pilot = pilot_of(system).name
    controller_a, file_a = controller_and_file(first, "A")
    controller_b, file_b = controller_and_file(second, "B")
    reset = reset or ("place" if system.truth else "reverse")
    params: dict[str, object] = {
        "train_s": 0,
        "evaluation_trials": 2 * pairs,
        "evaluation_controller": controller_a,
        "policy": file_a,
        "rival_controller": controller_b,
        "rival_policy": file_b,
        "evaluation_reset": reset,
    }
    if reset == "reverse":
        params["pick_up"] = False  # with the object in the gripper there is no next trial
    return [f"{pilot}.{name}={json.dumps(value)}" for name, value in params.items() if value != ""]


def _check(system: System) -> None:
    pilot = pilot_of(system)
    for name in ("policy", "rival_policy"):
        controller = pilot.params["evaluation_controller" if name == "policy" else "rival_controller"]
        if controller == "greedy" and not pilot.params[name]:
            raise ConfigurationError("A and B must be lc or a policy file; learner is still learning")


def _print(table: dict[str, Any]) -> None:
    console = Console(soft_wrap=True, highlight=False)
    for side in ("a", "b"):
        row = table[side]
        low, high = row["wilson_percent"]
        why = ", ".join(f"{name} {count}" for name, count in row["failures"].items())
        console.print(
            f"{side.upper()} {row['policy']}: {row['successes']} of {row['trials']} "
            f"({low} to {high} %, Wilson 95 %){'; ' + why if why else ''}"
        )
    console.print(f"{table['pairs']} pairs; only A {table['only_a']}, only B {table['only_b']}")
    verdict = {"a": "A is better", "b": "B is better"}.get(table["better"], "undecided")
    console.print(
        f"{verdict}: evidence {table['evidence']:g}, {1 / table['alpha']:g} decides (alpha {table['alpha']:g})"
    )
    for name in ("recording", "exit_reason"):
        console.print(f"{name:12} {table[name]}")
