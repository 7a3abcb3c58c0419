"""What a stranger wants to know within ten seconds: did it learn, does it dock, how fast, what went wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from docking.score import DOCKED_M, DOCKED_RAD, Trial
from experiments.sequential import wilson
from report.comparison import Comparison
from report.failures import counted
from report.incidents import Incident
from report.session import Session

_LEARNED, _PARTLY = 80.0, 50.0
"""Share of what is possible, percent."""
_WELL, _FAIRLY = 0.9, 0.6
"""Share of trials that dock."""
_ENOUGH = 10
"""Fewer trials do not show that it docks well."""
_GRAVE = frozenset({"died", "stopped", "lost", "stalled", "unusable"})


class Tile(NamedTuple):
    """One question and its answer."""

    question: str
    answer: str
    mark: str
    """good, fair, bad, or none where there is nothing to judge."""
    words: str


def tiles(session: Session, comparison: Comparison | None) -> list[Tile]:
    """The four of them."""
    return [_learned(session, comparison), _docks(session), _fast(session), _wrong(session)]


def judged(session: Session) -> tuple[str, list[Trial]]:
    """The trials that tell how good it is, and what they are: the evaluation, or else the training."""
    evaluation = session.of_phase("EVALUATE")
    return ("evaluation", evaluation) if evaluation else ("training", session.of_phase("TRAIN"))


def percent_range(successes: int, trials: int) -> str:
    """The 95 % interval (Wilson) in words."""
    low, high = wilson(successes, trials)
    return f"{100 * low:.0f} to {100 * high:.0f} %"


def _learned(session: Session, comparison: Comparison | None) -> Tile:
    question = "Did it learn?"
    if comparison is None:
        words = "It trained, but no policy is in the file." if session.of_phase("TRAIN") else "It did not train here."
        return Tile(question, "Not here", "none", words)
    last, first, best = comparison.alone[-1][1], comparison.alone[0], comparison.ceiling_percent
    share = 100 * last / best if best else 0.0
    answer, mark = ("Yes", "good") if share >= _LEARNED else ("Partly", "fair") if share >= _PARTLY else ("No", "bad")
    grown = f"; after {first[0]:.1f} min it was {first[1]:.0f} %" if len(comparison.alone) > 1 else ""
    words = (
        f"of {comparison.starts} starts reach the goal cell with what it learned alone{grown}. "
        f"The best that is possible is {best:.0f} %."
    )
    return Tile(question, f"{answer}: {last:.0f} %", mark, words)


def _docks(session: Session) -> Tile:
    question, (phase, trials) = "Does it dock?", judged(session)
    if not trials:
        return Tile(question, "Not tried", "none", "No trial ended in this session.")
    docked = sum(trial.docked for trial in trials)
    share = docked / len(trials)
    enough = len(trials) >= _ENOUGH
    mark = "good" if share >= _WELL and enough else "fair" if share >= _FAIRLY else "bad"
    meant = (
        f"gripper within {1e3 * DOCKED_M:.0f} mm and {math.degrees(DOCKED_RAD):.0f}\N{DEGREE SIGN}, by ground truth"
        if session.knows_truth
        else "as the robot itself tells; nobody measured"
    )
    picked = sum(trial.picked for trial in trials)
    likely = percent_range(docked, len(trials))
    words = f"trials of the {phase} docked: {meant}. 95 % interval {likely}; {picked} picked up."
    if not enough:
        words = f"{words} Too few trials to be sure."
    if phase == "training":
        mark, words = "none", f"{words} Training is not meant to dock."
    return Tile(question, f"{docked} of {len(trials)}", mark, words)


def _fast(session: Session) -> Tile:
    question, (phase, trials) = "How fast?", judged(session)
    took_s = [trial.duration_s for trial in trials if trial.docked]
    if not took_s:
        return Tile(question, "\N{EN DASH}", "none", "Nothing docked, so there is no time.")
    half, most = np.percentile(took_s, (50, 90))
    errors_mm = [1e3 * trial.gripper_error_m for trial in trials if trial.docked]
    exact = f" The gripper stood {np.median(errors_mm):.0f} mm from its pose." if session.knows_truth else ""
    words = f"to dock from the start, median of the {phase}; nine of ten within {most:.0f} s.{exact}"
    return Tile(question, f"{half:.1f} s", "none", words)


def _wrong(session: Session) -> Tile:
    phase, _ = judged(session)
    names = counted([f for f in session.failed if f.phase == {"evaluation": "EVALUATE"}.get(phase, "TRAIN")])
    told = [f"{count} \N{MULTIPLICATION SIGN} {name}" for name, count in names.items()]
    told = [f"Failed trials of the {phase}: {', '.join(told)}."] if told else []
    machinery = _machinery(session.incidents)
    if session.lost:
        machinery.append(f"{session.lost} messages lost")
    if not session.whole or session.damage:
        machinery.append("the file is damaged or torn")
    told += [f"Machinery: {', '.join(machinery)}."] if machinery else []
    if not told:
        words = f"No trial of the {phase} failed, nobody died, nothing late, nothing lost."
        return Tile("What went wrong?", "Nothing", "good", words)
    grave = [incident for incident in session.incidents if incident.kind in _GRAVE]
    failed = sum(names.values()) if phase == "evaluation" else 0
    bad = not session.whole or any(incident.kind in {"died", "stalled"} for incident in grave)
    return Tile("What went wrong?", _counted(failed, len(grave)), "bad" if bad else "fair", " ".join(told))


def _counted(failed: int, grave: int) -> str:
    words = [f"{failed} failed trial{'s' * (failed != 1)}"] if failed else []
    words += [f"{grave} fault{'s' * (grave != 1)}"] if grave else []
    return ", ".join(words) or "Little"


def _machinery(incidents: Sequence[Incident]) -> list[str]:
    found = []
    for kind, words in (
        ("died", "{} died or began again"),
        ("stalled", "{} stalled"),
        ("stopped", "base stopped the robot {} times"),
        ("unusable", "unusable images, {} times"),
        ("late", "inputs came late, {} times"),
        ("refused", "messages were refused, {} times"),
        ("missed", "inputs were missed, {} times"),
    ):
        own = [incident for incident in incidents if incident.kind == kind]
        if own:
            who = ", ".join(dict.fromkeys(incident.who for incident in own))
            found.append(words.format(who if kind in {"died", "stalled"} else len(own)).replace("1 times", "once"))
    return found
