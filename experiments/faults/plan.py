"""What is done to one running system, drawn from a seed. Pure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

SUPERVISOR, RECORDER, LEARNER = "supervisor", "recorder", "learner"
FOLDS = ("simulator", "vision", "head", "tracker", "pilot", LEARNER, "grasper", "base")
EVERYBODY = (*FOLDS, RECORDER, SUPERVISOR)
DEADLY, PASSING = ("kill", "memory", "crash"), ("pause", "slow")
"""kill -9; no more memory; an exception on a message. SIGSTOP for a while; a processor for a fifth of the time."""
_FEWEST_FRAMES, _MOST_FRAMES = 4, 40
_SHORTEST_S, _LONGEST_S = 0.1, 3.0
_PASSING_PER_SESSION = 4


@dataclass(frozen=True)
class Injection:
    """One thing done to one process."""

    fault: str
    victim: str
    frames: int = _FEWEST_FRAMES
    """Camera frames to wait for before; then until the robot moves."""
    lasts_s: float = 0.0
    """Of a passing fault."""
    alone: bool = False
    """The supervisor is frozen meanwhile, so that it can not help."""

    @property
    def restarts(self) -> bool:
        """Whether the victim dies and is started again."""
        return self.fault in DEADLY and self.victim == LEARNER


def deaths() -> list[Injection]:
    """Every way in which a session's process can die, but for the learner's, who is started again."""
    names = [name for name in EVERYBODY if name != LEARNER]
    found = [Injection(fault, name) for fault in DEADLY for name in names if fault != "crash" or name in FOLDS]
    return [replace(death, alone=death.victim == "base") for death in found]


def plan(seed: int) -> Sequence[Injection]:
    """One session: some passing faults, a death of the learner among them, and at last a death that ends it.

    The last one is the next of all in turn, so that as many seeds as there are deaths try each once.
    """
    rng = np.random.default_rng([seed, 10])
    drawn = [_passing(rng) for _ in range(_PASSING_PER_SESSION)]
    drawn.insert(int(rng.integers(len(drawn) + 1)), Injection(str(rng.choice(DEADLY)), LEARNER))
    last = deaths()[seed % len(deaths())]
    by_itself = last.fault != "memory" and last.victim != SUPERVISOR and rng.random() < 0.5
    timed = [replace(one, frames=int(rng.integers(_FEWEST_FRAMES, _MOST_FRAMES))) for one in (*drawn, last)]
    return (*timed[:-1], replace(timed[-1], alone=last.alone or by_itself))


def _passing(rng: np.random.Generator) -> Injection:
    lasts_s = float(np.exp(rng.uniform(np.log(_SHORTEST_S), np.log(_LONGEST_S))))
    return Injection(str(rng.choice(PASSING)), str(rng.choice(EVERYBODY)), lasts_s=round(lasts_s, 3))
