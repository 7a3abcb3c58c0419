"""One trial, mode by mode: wait, approach, servo, grasp, and the reverse after it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from components.pilot import diagnosis, reverse
from components.pilot.choice import is_at_goal, is_off_limits, landing_policy, steer, table_of
from components.pilot.evidence import Evidence, Forecast
from components.pilot.landing import has_landed, land
from components.pilot.progress import REST, Heard, Held, Mode, Outcome, Phase, Progress, Step, Wish
from components.pilot.rules import NS, Rules
from components.pilot.servo import has_arrived, servo
from components.pilot.sight import Sight
from docking.cells import SINK
from docking.policy import PolicyTable

_STILL_MPS, _STILL_RADPS = 0.01, 0.02
"""A base slower than this stands still."""
_HINDERED_S = 5.0
"""For so long after base has refused the way back, no policy asks for it again."""
_UNGRASPED = Wish(engaged=False)


class Frame(NamedTuple):
    """What one step of a trial is made from."""

    time_ns: int
    """Capture time."""
    sight: Sight
    heard: Heard
    table: PolicyTable | None


def begin(progress: Progress, time_ns: int, number: int) -> Progress:
    """A new trial that waits for its first sight of the object."""
    return replace(
        progress,
        mode=int(Mode.WAIT),
        mode_began_ns=time_ns,
        number=number,
        over=False,
        goal_reached=False,
        began_ns=time_ns,
        begun=False,
        seen_ns=time_ns,
        arrived_ns=-1,
        held=Held(),
        draws=0,
        turning=False,
        sent=(),
        evidence=Evidence(),
        forecast=Forecast(),
    )


def go_on(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """One frame of the trial."""
    seen_ns = frame.time_ns if frame.sight.visible else progress.seen_ns
    hindered = frame.heard.hindered_ns >= 0 and _since(frame, frame.heard.hindered_ns) < _HINDERED_S
    progress = replace(progress, answered_ns=frame.time_ns, seen_ns=seen_ns, hindered=hindered)
    progress = diagnosis.watched(rules, progress, frame.sight, frame.heard, frame.time_ns)
    progress, wish = _MODES[progress.mode](rules, progress, frame)
    if progress.over:
        return diagnosis.named(rules, progress, frame.heard.late_ns, frame.time_ns), wish
    return diagnosis.promised(progress, table_of(rules, frame.table, progress)), wish


def begin_reverse(rules: Rules, progress: Progress, frame: Frame) -> Progress:
    """Draw a start pose and drive back to it."""
    start = reverse.drawn_start(rules, rules.start_generator(progress), frame.sight)
    return replace(
        progress,
        mode=int(Mode.REVERSE),
        mode_began_ns=frame.time_ns,
        over=False,
        seen_ns=frame.time_ns,
        held=Held(),
        draws=progress.draws + 1,
        start=start,
        turning=False,
    )


def _wait(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Stand still until the object is in view."""
    if not frame.sight.visible:
        if _bumped(progress, frame):
            return _ended(progress, Outcome.COLLIDED)
        if _since(frame, progress.seen_ns) > rules.params.lost_s:
            return _ended(progress, Outcome.LOST)
        return progress, REST
    if not progress.begun:
        progress = replace(progress, begun=True, began_ns=frame.time_ns)
    mode = Mode.SERVO if progress.goal_reached else Mode.APPROACH
    return _MODES[mode](rules, replace(progress, mode=int(mode), mode_began_ns=frame.time_ns), frame)


def _approach(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Drive to the goal cell."""
    sight = frame.sight
    failure = _failure(rules, progress, frame)
    if failure is not None:
        return _ended(progress, failure)
    if not sight.visible:
        return _wait(rules, replace(progress, mode=int(Mode.WAIT), mode_began_ns=frame.time_ns), frame)
    if sight.too_close:
        return _ended(progress, Outcome.SINK)
    if not is_at_goal(rules, frame.table, progress, sight):
        return steer(rules, frame.table, progress, sight)
    progress = replace(progress, goal_reached=True)
    if progress.phase == Phase.TRAIN:
        return _ended(progress, Outcome.REACHED)
    return _servo(rules, replace(progress, mode=int(Mode.SERVO), mode_began_ns=frame.time_ns, held=Held()), frame)


def _servo(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Steer to the pick-up, stop, and call the grasper."""
    if progress.arrived_ns >= 0:
        return _settle(rules, progress, frame)
    failure = _failure(rules, progress, frame)
    if failure is not None:
        return _ended(progress, failure)
    if not frame.sight.visible:
        return _wait(rules, replace(progress, mode=int(Mode.WAIT), mode_began_ns=frame.time_ns), frame)
    if _has_arrived(rules, progress, frame):
        return replace(progress, arrived_ns=frame.time_ns), Wish(controller="servo")
    lands = landing_policy(rules, frame.table, progress) is not None
    return progress, land(rules, frame.sight) if lands else servo(rules, frame.sight)


def _has_arrived(rules: Rules, progress: Progress, frame: Frame) -> bool:
    lands = landing_policy(rules, frame.table, progress) is not None
    return has_landed(rules, frame.sight) if lands else has_arrived(rules, frame.sight)


def _settle(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Wait for the base to stand still; if it coasted past the goal, go on with the servo."""
    heard = frame.heard
    still = abs(heard.v_mps) < _STILL_MPS and abs(heard.omega_radps) < _STILL_RADPS
    fresh = heard.base_ns > progress.arrived_ns
    if not (still and fresh) and _since(frame, progress.arrived_ns) < rules.params.settle_s:
        return progress, Wish(controller="servo")
    if frame.sight.visible and not _has_arrived(rules, progress, frame):
        return _servo(rules, replace(progress, arrived_ns=-1), frame)
    if not rules.params.pick_up:
        return _ended(progress, Outcome.ARRIVED)
    return replace(progress, mode=int(Mode.GRASP), mode_began_ns=frame.time_ns), _UNGRASPED


def _grasp(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Leave the robot to the grasper until it is done."""
    heard = frame.heard
    if heard.grasp_done and heard.grasp_ns >= progress.mode_began_ns:
        return _ended(progress, Outcome.PICKED if heard.picked else Outcome.MISSED)
    if _since(frame, progress.mode_began_ns) > rules.params.grasp_timeout_s:
        return _ended(progress, Outcome.MISSED)
    return progress, _UNGRASPED


def _reverse(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Drive back, turn, and begin the next trial there; one begins too where a person leads the robot on from afar."""
    sight, start = frame.sight, progress.start
    if not sight.visible:
        return _search(rules, progress, frame)
    progress = replace(progress, seen_alpha_rad=sight.alpha_rad, seen_tilt_rad=sight.tilt_rad, searched=False)
    if not progress.turning and (reverse.is_far_enough(sight, start) or _is_hindered(rules, progress, frame)):
        progress = replace(progress, turning=True)
    late = _since(frame, progress.mode_began_ns) > rules.params.reverse_timeout_s
    there = progress.turning and reverse.has_turned(rules, sight, start)
    cell = rules.grid.cell(sight.beta_rad, sight.alpha_rad)
    if cell != SINK and (late or there or (cell != rules.grid.goal and _is_led(rules, progress, frame))):
        return _wait(rules, begin(progress, frame.time_ns, progress.number + 1), frame)
    if late:
        progress = begin_reverse(rules, progress, frame)
    move = reverse.turn if progress.turning else reverse.back_off
    return progress, move(rules, sight, progress.start)


def _is_led(rules: Rules, progress: Progress, frame: Frame) -> bool:
    """A person has begun to drive forwards, from as far as trials begin."""
    afar = frame.sight.tilt_rad <= rules.task.start_tilt_max_rad
    return afar and frame.heard.led_ns > progress.mode_began_ns


def _is_hindered(rules: Rules, progress: Progress, frame: Frame) -> bool:
    """Base drives no further back, and there is room to turn."""
    clear = frame.sight.tilt_rad <= rules.params.reverse_clear_tilt_rad
    return clear and frame.heard.hindered_ns > progress.mode_began_ns


def _search(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """Leave it to the head, then turn once round, then give the trial up by its name."""
    params = rules.params
    unseen_s = _since(frame, progress.seen_ns)
    if unseen_s <= params.lost_s:
        return progress, Wish(controller="reverse")
    clear = progress.seen_tilt_rad <= params.reverse_clear_tilt_rad
    if clear and not progress.searched and unseen_s <= params.lost_s + 2.0 * math.pi / params.search_turn_rate_radps:
        return progress, Wish(0.0, math.copysign(params.search_turn_rate_radps, progress.seen_alpha_rad), "search")
    seen_ns = progress.seen_ns
    progress = begin(replace(progress, searched=True), frame.time_ns, progress.number + 1)
    return _ended(replace(progress, seen_ns=seen_ns), Outcome.LOST)


def _place(rules: Rules, progress: Progress, frame: Frame) -> Step:
    """The robot has been placed: wait for the object."""
    return _wait(rules, replace(progress, mode=int(Mode.WAIT), mode_began_ns=frame.time_ns), frame)


def _failure(rules: Rules, progress: Progress, frame: Frame) -> Outcome | None:
    """Why a moving trial must end, whatever drives."""
    sight = frame.sight
    if _bumped(progress, frame):
        return Outcome.COLLIDED
    if sight.visible and is_off_limits(rules, frame.table, progress, sight):
        return Outcome.SINK
    if _since(frame, progress.began_ns) > rules.params.trial_timeout_s:
        return Outcome.TIMED_OUT
    return None


def _bumped(progress: Progress, frame: Frame) -> bool:
    return frame.heard.bumper and frame.heard.base_ns > progress.placed_ns


def _ended(progress: Progress, outcome: Outcome) -> Step:
    """Stop; the frame that ends a trial still shows the trial's mode, the next one reverses or places."""
    progress = replace(progress, outcome=int(outcome), ended=progress.ended + 1, over=True)
    return progress, Wish(controller=progress.held.controller, engaged=progress.mode != Mode.GRASP)


def _since(frame: Frame, time_ns: int) -> float:
    return (frame.time_ns - time_ns) / NS


_MODES: dict[int, Callable[[Rules, Progress, Frame], Step]] = {
    Mode.WAIT: _wait,
    Mode.APPROACH: _approach,
    Mode.SERVO: _servo,
    Mode.GRASP: _grasp,
    Mode.REVERSE: _reverse,
    Mode.PLACE: _place,
}
