"""Learning again from recordings, with the recorded parameters and with others, and what is predicted of both."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from components.learner.ports import Params
from experiments.logged_trials import trials_of
from experiments.prediction import Prediction, predict
from experiments.relearning import Inputs, Learned, SnapshotCheck, check_snapshots, inputs_of, relearn
from runtime.handed_over import HandedOver, handed_over
from runtime.params import ConfigurationError
from runtime.recorded_system import recorded_component
from runtime.recording import Recording
from runtime.replay import replay
from runtime.system import ComponentSpec, params_of, ports_of

FIGURES = {
    "known_percent": "held-out transitions that the model knows, %",
    "one_step_error": "held-out one-step error: probability of other exits than the one taken",
    "outcome_error": "held-out trial error: probability of the goal against what happened",
    "duration_error_s": "held-out trial error: duration to the goal, s",
    "controllable_percent": "controllable cells under the log's own model, %",
    "agreement_percent": "agreement with the recorded actions, %",
}
"""Field of `experiments.prediction.Prediction` -> its line."""


@dataclass(frozen=True)
class Lesson:
    """One set of parameters and what came of it."""

    name: str
    learned: Learned
    figures: Prediction | None


@dataclass(frozen=True)
class Lessons:
    """With the recorded parameters, and after that with others if they were asked for."""

    lessons: Sequence[Lesson]
    checks: Sequence[SnapshotCheck]
    """Of each session by itself."""
    notes: Sequence[str]
    is_lossy: bool
    """Something of a session is missing."""

    @property
    def same(self) -> bool | None:
        """Whether every session that can be compared gives the live learner's tables; None = none can be compared."""
        known = [check.same for check in self.checks if check.same is not None]
        return all(known) if known else None

    def policy(self) -> bytes:
        """The last lesson's policy, as a file's contents.

        Raises:
            ConfigurationError: nothing was learned.
        """
        policy = self.lessons[-1].learned.policy
        if policy is None:
            raise ConfigurationError("relearn: nothing was learned, so there is no policy to write")
        return policy.to_bytes()

    def lines(self) -> Iterator[str]:
        """For people."""
        yield from self.notes
        yield from _lines(self.lessons)

    def table(self) -> dict[str, Any]:
        """As one JSON object."""
        return {
            "same_as_live": self.same,
            "snapshots": sum(check.compared for check in self.checks),
            "notes": [*self.notes],
            "lessons": [_entry(lesson) for lesson in self.lessons],
        }


def learn(files: Sequence[Path], component: str, overrides: Sequence[str], *, compare: bool) -> Lessons:
    """Learn from the sessions in turn.

    Args:
        files: recordings.
        component: name of the learner in them.
        overrides: other parameters.
        compare: whether to work out the predictions.

    Raises:
        ConfigurationError: no such session, component or parameter, or nothing to learn from.
    """
    recordings = [Recording(file) for file in files]
    specs = [recorded_component(recording, component)[1] for recording in recordings]
    asked = recorded_component(recordings[0], component, overrides)[1]
    sessions = [_read(recording, spec) for recording, spec in zip(recordings, specs, strict=True)]
    inputs = inputs_of(sessions, _decoder(specs[0]))
    lessons = [_lesson("recorded", specs[0], inputs, compare=compare)]
    if asked != specs[0]:
        lessons.append(_lesson("asked for", asked, inputs, compare=compare))
    checks = [
        _check(recording, spec, session, lessons[0].learned if len(files) == 1 else None)
        for recording, spec, session in zip(recordings, specs, sessions, strict=True)
    ]
    notes = list(_notes(files, specs, sessions, checks))
    return Lessons(lessons, checks, notes, is_lossy=any(session.missing for session in sessions))


def _read(recording: Recording, spec: ComponentSpec) -> HandedOver:
    session = handed_over(recording, spec, [spec.outputs[port] for port in ("snapshot",) if port in spec.outputs])
    if not session.inputs:
        raise ConfigurationError(f"{recording.file}: must hold messages for {spec.name}; there are none")
    return session


def _decoder(spec: ComponentSpec) -> Callable[[str, bytes], Any]:
    ports = ports_of(spec.run).INPUTS
    return lambda port, payload: ports[port].schema.FromString(payload)


def _lesson(name: str, spec: ComponentSpec, inputs: Inputs, *, compare: bool) -> Lesson:
    params = params_of(spec)
    if not isinstance(params, Params):
        raise ConfigurationError(f"--component {spec.name}: must be a learner")
    learned = relearn(params, spec.seed, inputs)
    return Lesson(name, learned, predict(params, trials_of(params, inputs), learned.policy) if compare else None)


def _check(recording: Recording, spec: ComponentSpec, session: HandedOver, learned: Learned | None) -> SnapshotCheck:
    """Whether a session gives again what its learner has learned live, with its own parameters and by itself.

    Args:
        recording: the session.
        spec: of its learner.
        session: what was read of it.
        learned: from it alone; None = from others too, so it is learned from once more.
    """
    if session.restarted:
        return _check_run_by_run(recording, spec)
    if learned is None and session.others:
        learned = relearn(params_of(spec), spec.seed, inputs_of([session], _decoder(spec)))
    return check_snapshots(session, learned or Learned())


def _check_run_by_run(recording: Recording, spec: ComponentSpec) -> SnapshotCheck:
    """Of a learner that was started again and lost a part: each of its runs is replayed."""
    report = replay(recording, spec.name)
    same = False if report.differs else True if report.count("identical") else None
    ends = "".join(f"; {outcome.words}" for outcome in report.runs if outcome.stopped)
    found = f"{report.count('different')} of its outputs differ" if report.differs else "its outputs are the same"
    return SnapshotCheck(same, 0, f"started again, so compared run by run: {found}{ends}")


def _notes(
    files: Sequence[Path],
    specs: Sequence[ComponentSpec],
    sessions: Sequence[HandedOver],
    checks: Sequence[SnapshotCheck],
) -> Iterator[str]:
    for file, spec, session, check in zip(files, specs, sessions, checks, strict=True):
        other = "" if spec.params == specs[0].params else "; recorded with other parameters than the first one"
        torn = f"; not all of it is there: {session.missing}" if session.missing else ""
        yield f"{file}: {len(session.inputs)} messages in the order of the {session.order}{other}{torn}; {check.words}"


def _lines(lessons: Sequence[Lesson]) -> Iterator[str]:
    for lesson in lessons:
        policy = lesson.learned.policy
        learned = "nothing" if policy is None else f"{policy.known} cells from {policy.transitions} transitions"
        digest = "" if policy is None else f", table {policy.table_sha256.hex()[:16]}"
        yield f"parameters {lesson.name}: learned {learned}{digest}"
    if any(lesson.figures is None for lesson in lessons):
        return
    heads = "".join(f"{lesson.name:>12}" for lesson in lessons)
    yield f"{'':92}{heads}"
    for field, words in FIGURES.items():
        values = "".join(f"{_shown(getattr(lesson.figures, field)):>12}" for lesson in lessons)
        yield f"predicted: {words:81}{values}"


def _shown(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.3g}"


def _entry(lesson: Lesson) -> dict[str, Any]:
    policy, figures = lesson.learned.policy, lesson.figures
    predicted = {} if figures is None else figures._asdict()
    return {
        "parameters": lesson.name,
        "known_cells": 0 if policy is None else policy.known,
        "transitions": 0 if policy is None else policy.transitions,
        "table_sha256": "" if policy is None else policy.table_sha256.hex(),
        "predicted": {name: None if math.isnan(value) else value for name, value in predicted.items()},
    }
