"""Why a trial failed, from what the robot can know: percepts, odometry, and what base did with the commands.

The first rule that holds gives the name; what happened longer than `blame_s` before the end is not its cause.

- late command: base let a command go for its age within `blame_s`; at that frame.
- collision: the bumper closed; at the end.
- slip: within `blame_s` wheels and view disagreed, by `slip_turn_rad` about how far the robot had turned, or the view
  moved less than `slip_share` of what it used to for such a way; at that comparison.
- object lost: not seen for `lost_s`; when last seen.
- pick missed: the grasper says so; at the end.
- model wrong: the policy drove out of the cells, too near to the table or out of time, and its value in the first cell
  in which it acted had promised the goal (above 0), or its forecast (at least 50 %); at the end.
- timeout: out of time otherwise; at the end.
- unreachable: out of the cells or too near to the table, and the policy had expected no better; when the trial began.
  Or, whoever drove: the linear law had asked for more than the turn limit, and got it, for `lock_s`; since then.
- off course: out of the cells or too near to the table otherwise: somebody steered there; at the end.
"""

from __future__ import annotations

import math
from dataclasses import replace

from components.pilot.evidence import Anchor, Evidence, Scale
from components.pilot.progress import Failure, Heard, Mode, Outcome, Progress
from components.pilot.rules import NS, Rules
from components.pilot.sight import Sight
from docking.angles import wrap
from docking.cells import SINK
from docking.policy import PolicyTable

_FULL_TURN = 0.8
"""Share of the turn limit that counts as turning at it: odometry is a frame late and noisy."""
_LEARNING = 5
"""Comparisons of wheels and view before the scale between them is trusted."""
_FORGET = 0.1
"""Weight of a new comparison in the scale, once it is trusted."""
_OWN_NAMES = {
    Outcome.COLLIDED: Failure.COLLISION,
    Outcome.LOST: Failure.OBJECT_LOST,
    Outcome.MISSED: Failure.PICK_MISSED,
}
_SUCCESSES = frozenset({Outcome.NONE, Outcome.REACHED, Outcome.ARRIVED, Outcome.PICKED})


def watched(rules: Rules, progress: Progress, sight: Sight, heard: Heard, time_ns: int) -> Progress:
    """Collect a frame's evidence. Only a robot on its way can give any."""
    if progress.mode not in {Mode.APPROACH, Mode.SERVO} or not sight.visible:
        return replace(progress, evidence=replace(progress.evidence, anchor=Anchor(), lock_ns=-1))
    evidence = replace(progress.evidence, lock_ns=_lock_ns(rules, progress.evidence, sight, heard, time_ns))
    return _compared(rules, replace(progress, evidence=evidence), sight, heard, time_ns)


def promised(progress: Progress, table: PolicyTable | None) -> Progress:
    """Remember what the policy forecast, or what its value said of the first cell that it acted in."""
    held, share = progress.held, progress.forecast.share
    if progress.evidence.promise >= 0 or table is None or held.controller != "greedy":
        return progress
    promise = int(share >= 0.5) if share > 0.0 else int(table.value[held.cell] > 0.0)
    return replace(progress, evidence=replace(progress.evidence, promise=promise))


def named(rules: Rules, progress: Progress, late_ns: int, time_ns: int) -> Progress:
    """A trial that ends in this frame, with the name of its failure."""
    failure, failure_ns = failure_of(rules, progress, late_ns, time_ns)
    return replace(progress, failure=int(failure), failure_ns=failure_ns)


def failure_of(rules: Rules, progress: Progress, late_ns: int, time_ns: int) -> tuple[Failure, int]:
    """Name and time, by the table above; NO_FAILURE and -1 for a success."""
    outcome, evidence = Outcome(progress.outcome), progress.evidence
    if outcome in _SUCCESSES:
        return Failure.NO_FAILURE, -1
    since_ns = max(progress.began_ns, time_ns - round(rules.params.blame_s * NS))
    if late_ns >= since_ns:
        return Failure.LATE_COMMAND, min(late_ns, time_ns)  # a frame that comes late is younger than the stop for it
    if outcome == Outcome.COLLIDED:
        return Failure.COLLISION, time_ns
    if evidence.slip_ns >= since_ns:
        return Failure.SLIP, evidence.slip_ns
    if outcome in _OWN_NAMES:
        return _OWN_NAMES[outcome], progress.seen_ns if outcome == Outcome.LOST else time_ns
    return _way_missed(rules, progress, outcome, time_ns)


def _way_missed(rules: Rules, progress: Progress, outcome: Outcome, time_ns: int) -> tuple[Failure, int]:
    evidence = progress.evidence
    if progress.held.controller == "greedy" and evidence.promise > 0:
        return Failure.MODEL_WRONG, time_ns
    if outcome == Outcome.TIMED_OUT:
        return Failure.TIMEOUT, time_ns
    if progress.held.controller == "greedy" and evidence.promise == 0:
        return Failure.UNREACHABLE, progress.began_ns
    if 0 <= evidence.lock_ns <= time_ns - rules.params.lock_s * NS:
        return Failure.UNREACHABLE, evidence.lock_ns
    return Failure.OFF_COURSE, time_ns


def _lock_ns(rules: Rules, evidence: Evidence, sight: Sight, heard: Heard, time_ns: int) -> int:
    limit = rules.task.turn_rate_radps
    wanted = rules.teacher.omega_radps(sight.beta_rad, sight.alpha_rad)
    locked = abs(wanted) >= limit and heard.omega_radps * math.copysign(1.0, wanted) >= _FULL_TURN * limit
    if rules.grid.cell(sight.beta_rad, sight.alpha_rad) == SINK:
        return evidence.lock_ns
    return (evidence.lock_ns if evidence.lock_ns >= 0 else time_ns) if locked else -1


def _compared(rules: Rules, progress: Progress, sight: Sight, heard: Heard, time_ns: int) -> Progress:
    """Compare wheels and view over a stretch of way and time."""
    params, evidence, anchor = rules.params, progress.evidence, progress.evidence.anchor
    here = _anchor(sight, heard, time_ns)
    if anchor.time_ns < 0:
        return replace(progress, evidence=replace(evidence, anchor=here))
    way_m = math.hypot(here.odometry_x_m - anchor.odometry_x_m, here.odometry_y_m - anchor.odometry_y_m)
    if time_ns - anchor.time_ns < params.slip_window_s * NS:
        return progress
    turned = wrap(here.odometry_heading_rad - anchor.odometry_heading_rad)
    seen = wrap(here.seen_heading_rad - anchor.seen_heading_rad)
    slipped = abs(wrap(turned - seen)) > params.slip_turn_rad
    scale = progress.scale
    if way_m >= params.slip_way_m:
        per_m = math.hypot(here.seen_x - anchor.seen_x, here.seen_y - anchor.seen_y) / way_m
        slipped = slipped or (scale.comparisons >= _LEARNING and per_m < params.slip_share * scale.per_m)
        scale = scale if slipped else _learned(scale, per_m)
    slip_ns = time_ns if slipped else evidence.slip_ns
    return replace(progress, evidence=replace(evidence, anchor=here, slip_ns=slip_ns), scale=scale)


def _learned(scale: Scale, per_m: float) -> Scale:
    weight = max(_FORGET, 1.0 / (scale.comparisons + 1))
    return Scale(scale.per_m + weight * (per_m - scale.per_m), scale.comparisons + 1)


def _anchor(sight: Sight, heard: Heard, time_ns: int) -> Anchor:
    away = 1.0 / math.tan(sight.tilt_rad)
    place = (-away * math.cos(sight.beta_rad), -away * math.sin(sight.beta_rad))
    wheels = (heard.odometry_x_m, heard.odometry_y_m, heard.odometry_heading_rad)
    return Anchor(time_ns, *wheels, *place, sight.beta_rad - sight.alpha_rad)
