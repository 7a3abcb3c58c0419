"""What was promised, tried and held: one row for each promise that an injection put to the test."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields

BRAKES = "told to stand, or brakes by itself, within 0.3 s of its clock"
WORD = "base's word to move stands only while the frame that it answers is younger than 0.3 s, by its clock"
FRESH = "the robot, too, is driven by nothing older (of a base that was hit itself: by its own watchdog, 0.3 s)"
REASON = "the session goes on, or ends and names who died"
NOBODY = "no process is left behind"
READABLE = "the recording is readable, at most 1 s of it lost"
TRIAL = "a learner that is started again has lost at most one trial"
SHELLS = ("live", "in-process")
PROMISES = (BRAKES, WORD, FRESH, REASON, NOBODY, READABLE, TRIAL)


@dataclass(frozen=True, slots=True)
class Verdict:
    """One promise after one injection."""

    experiment: str
    seed: int
    shell: str
    """`live`: processes on the bus. `in-process`: folds under a virtual clock."""
    injection: int
    """Number in its session."""
    fault: str
    victim: str
    promise: str
    held: bool
    measured: float | None = None
    """Seconds, or trials; None where nothing is measured."""
    note: str = ""
    """What was wrong, or how the session ended."""


def verdict_of(table: dict[str, object]) -> Verdict:
    """A row from plain values, out of JSON.

    Raises:
        ValueError: a column is missing, unknown or not what it must be.
    """
    if set(table) != {field.name for field in fields(Verdict)}:
        raise ValueError(f"columns must be those of a verdict; got {', '.join(table)}")
    measured = table["measured"]
    return Verdict(
        experiment=str(table["experiment"]),
        seed=int(str(table["seed"])),
        shell=str(table["shell"]),
        injection=int(str(table["injection"])),
        fault=str(table["fault"]),
        victim=str(table["victim"]),
        promise=str(table["promise"]),
        held=table["held"] is True,
        measured=None if measured is None else float(str(measured)),
        note=str(table["note"]),
    )


def summary(rows: Sequence[Verdict]) -> Iterator[tuple[str, ...]]:
    """A header, then for each promise and shell how often it was tried, how often it held, and the worst measured."""
    yield ("promise", "shell", "tried", "held", "worst", "not held")
    for promise in PROMISES:
        for shell in SHELLS:
            tried = [row for row in rows if (row.promise, row.shell) == (promise, shell)]
            if tried:
                yield (promise, shell, *_cells(tried))
    for shell in SHELLS:
        yield (
            "injections",
            shell,
            str(len({(row.seed, row.injection) for row in rows if row.shell == shell})),
            *[""] * 3,
        )


def _cells(tried: Sequence[Verdict]) -> tuple[str, ...]:
    broken = [row for row in tried if not row.held]
    measured = [row.measured for row in tried if row.measured is not None]
    names = sorted({f"{row.fault} {row.victim}" for row in broken})
    worst = f"{max(measured):.3f}" if measured else ""
    return str(len(tried)), str(len(tried) - len(broken)), worst, ", ".join(names)
