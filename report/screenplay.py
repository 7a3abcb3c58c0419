"""Which frames of a session a film shows, and for how long: acts, each a stretch of the session at one pace."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from report.reel import Moment, Reel

FPS = 12
FIRST_S, LAPSE_S, ONE_S, REST_S, END_S = 4.0, 9.0, 5.0, 3.0, 2.5
"""Of the film: the first trials, the rest of the training, one evaluation trial, the others, the last picture."""
FIRST_PACE = 8.0
"""Session seconds a second at the beginning."""
STILL_FRAMES = 4
"""In a time lapse the camera's picture stands for so many frames: another one in each would only flicker."""


class Cue(NamedTuple):
    """One picture of the film."""

    moment: Moment
    camera_ns: int
    """Capture time of the image that is shown."""
    caption: str
    pace: float
    """Session seconds a second."""
    stands_s: float
    """How long it is shown."""


def cues(reel: Reel) -> list[Cue]:
    """The film. A session without training, or without evaluation, has a shorter one."""
    shown = [moment for moment in reel.moments if moment.frame.mode not in {"WAIT", "PLACE"}] or reel.moments
    training = [moment for moment in shown if moment.frame.phase == "TRAIN"]
    evaluation = [moment for moment in shown if moment.frame.phase == "EVALUATE"]
    film = [*_training(training), *_evaluation(evaluation)] or [*_act(shown, LAPSE_S, "")]
    return [*film, _end(film[-1], [trial.docked for trial in reel.trials if trial.phase == "EVALUATE"])]


def _end(last: Cue, docked: Sequence[bool]) -> Cue:
    """The last picture, with what came of it all."""
    caption = f"docked from {sum(docked)} of {len(docked)} new starts" if docked else last.caption
    return last._replace(camera_ns=last.moment.capture_ns, caption=caption, stands_s=END_S)


def _training(moments: Sequence[Moment]) -> Iterator[Cue]:
    if not moments:
        return
    cut = bisect_left(moments, moments[0].frame.time_s + FIRST_S * FIRST_PACE, key=_time_s)
    yield from _act(moments[:cut], FIRST_S, "the first trials: it knows nothing")
    yield from _act(moments[cut:], LAPSE_S, "learning, trial by trial", still=STILL_FRAMES)


def _evaluation(moments: Sequence[Moment]) -> Iterator[Cue]:
    if not moments:
        return
    first = moments[0].frame.number
    cut = bisect_left(moments, first + 1, key=lambda moment: moment.frame.number)
    yield from _act(moments[:cut], ONE_S, "what it learned, from a new start")
    yield from _act(moments[cut:], REST_S, "... and from others", still=STILL_FRAMES)


def _act(moments: Sequence[Moment], film_s: float, caption: str, still: int = 1) -> Iterator[Cue]:
    """A stretch of the session, evenly."""
    count = min(len(moments), round(film_s * FPS))
    if not count:
        return
    chosen = [moments[index * (len(moments) - 1) // max(1, count - 1)] for index in range(count)]
    pace = (_time_s(moments[-1]) - _time_s(moments[0])) / film_s
    for index, moment in enumerate(chosen):
        yield Cue(moment, chosen[index - index % still].capture_ns, caption, pace, 1.0 / FPS)


def _time_s(moment: Moment) -> float:
    return moment.frame.time_s
