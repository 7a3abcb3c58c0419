"""Faults of every process at random moments, and what holds nevertheless: processes on the bus, then folds alone.

A seed is one session of real processes, shot at with signals and limits (`plan`), and one of the same folds
under a virtual clock, whose messages are lost, late and doubled (`tampering`).
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import fields
from pathlib import Path

from experiments.campaign import Job, Options
from experiments.faults.plan import Injection, plan
from experiments.faults.rules import Session, simulated_robot
from experiments.faults.session import RECORDING, NeverMovedError, run_session
from experiments.faults.tampering import Tampered
from experiments.faults.timeline import Moved, Told, timeline
from experiments.faults.verdict import SHELLS, Verdict, summary, verdict_of
from experiments.form import Form
from experiments.watched import Watched

NAME = "faults"
SEEDS = 25
"""Of six injections into processes each, and of 24 into folds. Each death that ends a session is tried once."""
_STARTS = 3
FORM = Form(
    tuple(field.name for field in fields(Verdict)),
    verdict_of,
    summary,
    "worst: seconds (trials, for the learner); docs/promises.md says what is not promised",
)


def jobs(options: Options) -> Sequence[Job]:
    """Two for each seed."""
    return [{"seed": seed, "shell": shell} for seed in options.seeds_or(SEEDS) for shell in SHELLS]


def run(job: Job) -> Sequence[Verdict]:
    """One session; the evidence of a live one is kept where a promise was broken."""
    seed = int(job["seed"] or 0)
    if job["shell"] == "in-process":
        return tamper(seed)
    folder, found = _shot(seed)
    if all(verdict.held for verdict in found):
        shutil.rmtree(folder)
    else:
        print(f"faults, seed {seed}: evidence in {folder}", flush=True)
    return found


def draw(rows: Sequence[Verdict], folder: Path) -> Sequence[Path]:
    """Nothing: the table says it all."""
    del rows, folder
    return ()


def tamper(seed: int) -> list[Verdict]:
    """A session of folds, tampered with as the seed says, and judged."""
    session = Tampered(seed, simulated_robot())
    session.run()
    return list(session.verdicts(NAME, seed))


def _shot(seed: int) -> tuple[Path, list[Verdict]]:
    """A live session, tried again where it did not begin: its folder and verdicts."""
    for _ in range(_STARTS - 1):
        with suppress(NeverMovedError):
            return _once(seed)
    return _once(seed)


def _once(seed: int) -> tuple[Path, list[Verdict]]:
    folder = Path(tempfile.mkdtemp(prefix="berth-faults-"))
    return folder, judged(plan(seed), seed, folder)


def judged(injections: Sequence[Injection], seed: int, folder: Path) -> list[Verdict]:
    """A session of real processes, done to as is said, and judged."""
    happened, watched = run_session(injections, seed, folder)
    line = timeline(folder / RECORDING, *watched_in(happened.origin_ns, watched))
    return list(Session(happened, line, folder / RECORDING, simulated_robot()).verdicts(NAME, seed))


def watched_in(origin_ns: int, watched: Watched) -> tuple[list[Moved], list[Told]]:
    """What a bystander saw, in session time."""
    seen = watched.seen
    truths = [Moved(one.capture_ns, one.v_mps, one.omega_radps) for one in seen.truths]
    commands = [Told(one.capture_ns, one.at_ns - origin_ns, one.v_mps, one.omega_radps) for one in seen.commands]
    return truths, commands
