"""Whether a robot moved only as long as it was told to, and how soon it began to brake. Pure."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from experiments.faults.timeline import Moved, Timeline, Told

NS = 1_000_000_000
_LEAST_FALL = 1e-9
"""Less is rounding."""


@dataclass(frozen=True)
class Robot:
    """What the rules need to know of it."""

    max_age_s: float
    """A command moves it until the frame that it answers is so old."""
    latency_s: float
    """From a command to its effect, in whole steps of the world."""
    watchdog_s: float
    """Without a command for so long it brakes by itself."""
    acceleration_mps2: float
    angular_acceleration_radps2: float
    catch_up_s: float = 2.0
    """A simulated world that was stopped for longer does not catch up: its robot stood as still as its clock."""

    def valid_ns(self, told: Told, *, deaf: bool) -> int:
        """When a command to move must have ended; `deaf`: base is out of action, and the watchdog alone counts."""
        end_ns = told.said_ns + self.watchdog_s * NS if deaf else told.frame_ns + self.max_age_s * NS
        return round(end_ns + self.latency_s * NS)


def late_s(robot: Robot, line: Timeline, since_ns: int, until_ns: int, *, deaf: bool) -> float:
    """By how much the robot began to brake too late, at the worst; 0 or less = never.

    A robot that moves though no command is valid must have been braking since the last one was: from its speed follows
    when it began to.
    """
    found = (_late_ns(robot, line, truth, deaf=deaf) for truth in _during(line, since_ns, until_ns))
    return max((late / NS for late in found), default=0.0)


def _during(line: Timeline, since_ns: int, until_ns: int) -> Iterator[Moved]:
    return (truth for truth in line.truths if since_ns <= truth.at_ns < until_ns and not truth.still)


def _late_ns(robot: Robot, line: Timeline, truth: Moved, *, deaf: bool) -> float:
    told = [command for command in line.commands if command.said_ns <= truth.at_ns and not command.still]
    if not told:
        return 0.0
    valid = max((robot.valid_ns(command, deaf=deaf), command) for command in told[-8:])
    over_ns = truth.at_ns - valid[0] - _stood_ns(robot, line, valid[0], truth.at_ns)
    if over_ns <= 0:
        return 0.0
    before = line.truths[max(0, bisect_right(line.truths, valid[0], key=lambda one: one.at_ns) - 1)]
    since_s = (valid[0] - before.at_ns) / NS
    braked_s = [
        _braked_s(abs(told), abs(was), abs(now), since_s, rate)
        for told, was, now, rate in (
            (valid[1].v_mps, before.v_mps, truth.v_mps, robot.acceleration_mps2),
            (valid[1].omega_radps, before.omega_radps, truth.omega_radps, robot.angular_acceleration_radps2),
        )
        if now
    ]
    return over_ns - min(braked_s) * NS


def _stood_ns(robot: Robot, line: Timeline, since_ns: int, until_ns: int) -> int:
    """For how long the world was stopped."""
    times = [truth.at_ns for truth in line.truths if since_ns - NS <= truth.at_ns <= until_ns]
    longest_ns = robot.catch_up_s * NS
    return sum(now_ns - max(was_ns, since_ns) for was_ns, now_ns in pairwise(times) if now_ns - was_ns > longest_ns)


def _braked_s(told: float, was: float, now: float, since_s: float, rate: float) -> float:
    """For how long it has braked from the highest speed that it can have had."""
    fastest = max(was, min(told, was + rate * since_s))
    return max(0.0, fastest - now) / rate


def stale_s(robot: Robot, line: Timeline, since_ns: int, until_ns: int) -> float | None:
    """By how much a word of base to move stood longer than its frame allows, by base's own clock, at the worst.

    None if no word to move was followed by another one in that time.
    """
    words = (pair for pair in pairwise(line.commands) if since_ns <= pair[1].said_ns < until_ns and not pair[0].still)
    ages_s = [(after.said_ns - told.frame_ns) / NS for told, after in words]
    return max(ages_s) - robot.max_age_s if ages_s else None


def stop_s(robot: Robot, line: Timeline, at_ns: int) -> float | None:
    """How long after a fault the robot was told to stand, or began to brake by itself.

    None if it was not driving then, or if fresh frames went on to move it: the fault took nothing that it needs.
    """
    driving = [command for command in line.commands if command.said_ns <= at_ns]
    if not driving or driving[-1].still:
        return None
    later = [command for command in line.commands if command.said_ns > at_ns]
    first = next((command for command in later if command.still), None)
    horizon_ns = at_ns + round(robot.max_age_s * NS) if first is None else first.said_ns
    if any(command.frame_ns > at_ns for command in later if command.said_ns < horizon_ns and not command.still):
        return None
    times = [_brakes_ns(robot, line, at_ns), None if first is None else first.said_ns]
    known = [time_ns for time_ns in times if time_ns is not None]
    return (min(known) - at_ns) / NS if known else None


def _brakes_ns(robot: Robot, line: Timeline, at_ns: int) -> int | None:
    """When its speed (of a robot that only turns: its turn rate) began to fall; None if it never did.

    Told from the first two truths between which it fell.
    """
    first = max(0, bisect_right(line.truths, at_ns, key=lambda truth: truth.at_ns) - 1)
    after = line.truths[first:]
    drives = bool(after) and after[0].v_mps != 0.0
    rate = robot.acceleration_mps2 if drives else robot.angular_acceleration_radps2
    speeds = [(truth.at_ns, abs(truth.v_mps if drives else truth.omega_radps)) for truth in after]
    for (before_ns, was), (now_ns, now) in pairwise(speeds):
        if now_ns > at_ns and was - now > _LEAST_FALL:
            return max(now_ns - round((was - now) / rate * NS), before_ns)
    return None
