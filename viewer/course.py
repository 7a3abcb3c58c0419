"""The session's trials: how each ended, where it went, and the learning curve."""

from __future__ import annotations

import math
from collections import deque

from docking.score import Frame, Scorer
from docking.score import Trial as Scored
from report.frames import is_sane, joined
from report.pairs import Pairs
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial
from schemas.truth_pb2 import Truth
from viewer.room import Room
from viewer.shown import Colour, Lines, Number, Remark, Shown, What, Word

DOCKED, REACHED, FAILED = (26, 127, 55, 255), (31, 111, 235, 255), (207, 34, 46, 255)
WINDOW = 20
"""Trials over which success is counted, as in the report."""
PATHS = 40
"""Ended trials whose way stays on the plan."""


class Course:
    """Folds the pilot's words, joined with where the robot was, into what became of its trials."""

    def __init__(self, room: Room) -> None:
        """No trial yet."""
        self._room = room
        self._scorer = Scorer()
        self._truths: Pairs[Trial, Truth] = Pairs()
        self._beliefs: Pairs[Trial, Percept] = Pairs()
        self._knows = False
        self._newest: dict[str, deque[bool]] = {}
        self._words: dict[str, str] = {}
        self._place: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self.trial: Trial | None = None
        """The pilot's newest word."""
        self.ended = 0
        self.counts = {"reached": 0, "docked": 0, "picked": 0}

    def said(self, message: Trial, capture_ns: int) -> list[Shown]:
        """The pilot's word of one frame."""
        if not is_sane(message):
            return []
        self.trial = message
        shown = self._changed("pilot/phase", Trial.Phase.Name(message.phase).lower(), capture_ns)
        shown += self._changed("pilot/mode", Trial.Mode.Name(message.mode).lower(), capture_ns)
        shown += self._changed("pilot/controller", message.controller, capture_ns)
        known = self._truths.first(capture_ns, message)
        if known is not None:
            return shown + self._score(joined(*known, capture_ns), capture_ns)
        if not self._knows:
            shown += self._think(self._beliefs.first(capture_ns, message), capture_ns)
        return shown

    def truth(self, message: Truth, capture_ns: int) -> list[Shown]:
        """Where the robot was."""
        if not is_sane(message):
            return []
        self._knows = True
        pair = self._truths.second(capture_ns, message)
        return self._score(joined(*pair, capture_ns), capture_ns) if pair is not None else []

    def percept(self, message: Percept, capture_ns: int) -> list[Shown]:
        """Where it thought it was; counts as long as there is no truth."""
        return [] if self._knows else self._think(self._beliefs.second(capture_ns, message), capture_ns)

    def _think(self, pair: tuple[Trial, Percept] | None, capture_ns: int) -> list[Shown]:
        if pair is None:
            return []
        trial, percept = pair
        self._place = self._room.believed(percept) or self._place
        return self._score(_believed(trial, self._place, capture_ns), capture_ns)

    def _score(self, frame: Frame, capture_ns: int) -> list[Shown]:
        ended = self._scorer.frame(frame)
        if ended is None:
            return []
        self._scorer.trials.clear()  # they are counted here; a session may be long
        return self._ended(ended, capture_ns)

    def _ended(self, trial: Scored, capture_ns: int) -> list[Shown]:
        newest = self._newest.setdefault(trial.controller, deque(maxlen=WINDOW))
        newest.append(trial.reached)
        for name in self.counts:
            self.counts[name] += getattr(trial, name)
        way = Lines((tuple(trial.path),) if len(trial.path) > 1 else (), _colour(trial), 1.0)
        shown: dict[str, What] = {
            f"plan/trials/{self.ended % PATHS:02}": way,
            f"learning/{_slug(trial.controller)}": Number(100.0 * sum(newest) / len(newest)),
            "log/trials": Remark(self._sentence(trial), is_bad=not (trial.reached or trial.picked)),
        }
        self.ended += 1
        return [Shown(entity, capture_ns, what) for entity, what in shown.items()]

    def _sentence(self, trial: Scored) -> str:
        ends = [name for name in self.counts if getattr(trial, name)] or [trial.outcome.lower().replace("_", " ")]
        failure = Trial.Failure.Name(self.trial.failure) if self.trial is not None and _fails(self.trial) else ""
        why = f" ({failure.lower().replace('_', ' ')})" if failure and not trial.reached else ""
        return f"{trial.phase.lower()} trial {trial.number}, {trial.controller}: {', '.join(ends)}{why}"

    def _changed(self, entity: str, word: str, capture_ns: int) -> list[Shown]:
        if self._words.get(entity) == word:
            return []
        self._words[entity] = word
        return [Shown(entity, capture_ns, Word(word))]


def _believed(trial: Trial, place: tuple[float, float, float], capture_ns: int) -> Frame:
    """A frame of a robot that nobody can place: the gripper's error is unknown, so nothing counts as docked."""
    nowhere = Truth(x_m=place[0], y_m=place[1], heading_rad=place[2])
    frame = joined(trial, nowhere, capture_ns)
    picked = trial.outcome == Trial.PICKED
    return frame._replace(gripper_lateral_m=math.inf, gripper_longitudinal_m=math.inf, holding=picked)


def _fails(trial: Trial) -> bool:
    return trial.failure != Trial.NO_FAILURE and trial.failure in Trial.Failure.values()


def _colour(trial: Scored) -> Colour:
    if trial.docked or trial.picked:
        return DOCKED
    return REACHED if trial.reached else FAILED


def _slug(controller: str) -> str:
    """As part of an entity's name; the pilot's word may come from a stranger."""
    return "".join(letter if letter.isalnum() else "-" for letter in controller)[:24] or "unknown"
