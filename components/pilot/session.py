"""The phases of a session: train, evaluate with the frozen policy, finished."""

from __future__ import annotations

from dataclasses import replace

from components.pilot.progress import Failure, Mode, Outcome, Phase, Progress, Step, Wish
from components.pilot.rules import NS, Rules
from components.pilot.shadow import advise
from components.pilot.sight import UNSEEN
from components.pilot.trial import Frame, begin, begin_reverse, go_on

_FINISHED = Wish(engaged=False)


def step(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """One frame of the session."""
    if rules.params.shadow:
        return advise(rules, progress, frame.sight, frame.table, frame.time_ns)
    phase = _phase(rules, progress, frame.time_ns)
    if phase != progress.phase or progress.phase_began_ns < 0:
        return _enter(rules, progress, frame, phase)
    if phase == Phase.FINISHED:
        return replace(progress, answered_ns=frame.time_ns), _FINISHED
    placed = phase == Phase.EVALUATE and rules.params.evaluation_reset == "place"
    if progress.over and placed:
        return _place(progress, frame.time_ns, progress.number + 1)
    if progress.over:
        progress = begin_reverse(rules, progress, frame)
    if placed and frame.time_ns - progress.placed_ns < rules.params.placing_s * NS:
        frame = frame._replace(sight=UNSEEN)
    return go_on(rules, progress, frame)


def _phase(rules: Rules, progress: Progress, time_ns: int) -> Phase:
    """Phase of this frame; phases with nothing to do are passed over."""
    phase = Phase(progress.phase)
    began_ns = time_ns if progress.phase_began_ns < 0 else progress.phase_began_ns
    if phase == Phase.TRAIN and time_ns - began_ns >= rules.params.train_s * NS:
        phase, progress = Phase.EVALUATE, replace(progress, ended=0)
    if phase == Phase.EVALUATE and progress.ended >= rules.params.evaluation_trials:
        return Phase.FINISHED
    return phase


def _enter(rules: Rules, progress: Progress, frame: Frame, phase: Phase) -> Step:
    time_ns = frame.time_ns
    if phase != Phase.FINISHED:
        progress = replace(progress, outcome=int(Outcome.NONE), failure=int(Failure.NO_FAILURE), failure_ns=-1, ended=0)
    progress = replace(progress, phase=int(phase), phase_began_ns=time_ns, answered_ns=time_ns)
    if phase == Phase.TRAIN:
        return go_on(rules, begin(progress, time_ns, 0), frame)
    if phase == Phase.EVALUATE and rules.params.evaluation_reset == "place":
        return _place(progress, time_ns, 0)
    if phase == Phase.EVALUATE:
        return go_on(rules, begin(progress, time_ns, 0), frame)
    return replace(progress, mode=int(Mode.WAIT), mode_began_ns=time_ns, over=False), _FINISHED


def _place(progress: Progress, time_ns: int, number: int) -> Step:
    progress = replace(begin(progress, time_ns, number), mode=int(Mode.PLACE), placed_ns=time_ns, answered_ns=time_ns)
    return progress, Wish(place=True)
