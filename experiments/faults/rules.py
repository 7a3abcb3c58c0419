"""The promises, judged after a session: from its recording, from its end, and from what a bystander saw."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from components.base.ports import Params as Base
from components.simulator.params import SUBSTEPS_HZ
from components.simulator.params import Params as World
from experiments.faults.lessons import trials_lost
from experiments.faults.motion import NS, Robot, late_s, stale_s, stop_s
from experiments.faults.plan import RECORDER, SUPERVISOR
from experiments.faults.session import Happened, Incident
from experiments.faults.timeline import Timeline, is_recording
from experiments.faults.verdict import BRAKES, FRESH, NOBODY, READABLE, REASON, TRIAL, WORD, Verdict
from runtime.recording import Recording

STEP_S = 1.0 / SUBSTEPS_HZ
_LOST_S, _LOST_TRIALS = 1.0, 0
_OFTEN_HZ = 4.0
"""A topic that is slower has no rate from which a loss could be told in seconds."""
Found = tuple[str, bool, float | None, str]
"""Promise, whether it held, what was measured, a note."""


def simulated_robot() -> Robot:
    """As base and simulator are by default."""
    base, world = Base(), World()
    latency_s = (int(world.command_latency_s / STEP_S) + 1) * STEP_S
    return Robot(
        base.max_age_s, latency_s, world.watchdog_s, world.acceleration_mps2, world.angular_acceleration_radps2
    )


@dataclass(frozen=True)
class Session:
    """What is judged."""

    happened: Happened
    line: Timeline
    file: Path
    robot: Robot

    def verdicts(self, experiment: str, seed: int) -> Iterator[Verdict]:
        """What each injection has shown."""
        for number, incident in enumerate(self.happened.incidents):
            done = incident.injection
            for promise, held, measured, note in self._judged(incident):
                yield Verdict(experiment, seed, "live", number, done.fault, done.victim, promise, held, measured, note)

    def _judged(self, incident: Incident) -> Iterator[Found]:
        rules: tuple[Callable[[Incident], Found | None], ...] = (
            self._brakes, self._word, self._fresh, self._reason, self._nobody, self._readable, self._trial,
        )  # fmt: skip
        return (found for rule in rules if (found := rule(incident)) is not None)

    def _brakes(self, incident: Incident) -> Found | None:
        """The world itself is out of action if it was hit; then only commands tell."""
        after_s = stop_s(self.robot, self.line, incident.at_ns)
        if after_s is None:
            return None
        limit_s = self.robot.max_age_s + self.robot.latency_s + STEP_S
        return BRAKES, after_s <= limit_s, after_s, "" if after_s <= limit_s else f"more than {limit_s:.3f} s"

    def _word(self, incident: Incident) -> Found | None:
        """A base that was hit itself has no word."""
        if incident.injection.victim == "base":
            return None
        stale = stale_s(self.robot, self.line, incident.at_ns, incident.next_ns)
        return None if stale is None else (WORD, stale <= 0.0, stale, "" if stale <= 0.0 else self._halted(incident))

    def _fresh(self, incident: Incident) -> Found:
        deaf = incident.injection.victim == "base"
        late = late_s(self.robot, self.line, incident.at_ns, incident.next_ns, deaf=deaf)
        return FRESH, late <= STEP_S, late, "" if late <= STEP_S else self._halted(incident)

    def _halted(self, incident: Incident) -> str:
        """For how long base, which ticks every 20 ms, had no processor: on a busy machine that explains it."""
        during = [at_ns for at_ns in self.line.ticks_ns if incident.at_ns <= at_ns < incident.next_ns]
        longest_s = max((after - before for before, after in pairwise(during)), default=0) / NS
        return f"base did not run for {longest_s:.3f} s"

    def _reason(self, incident: Incident) -> Found:
        happened, done = self.happened, incident.injection
        if incident.back or incident is not happened.incidents[-1]:
            return REASON, incident.back, None, "goes on" if incident.back else "the robot did not move again"
        named = happened.reason.startswith(done.victim) or (done.victim == SUPERVISOR and happened.code != 0)
        return REASON, happened.ended and incident.died and named, None, happened.reason

    def _nobody(self, incident: Incident) -> Found | None:
        if incident is not self.happened.incidents[-1]:
            return None
        left = len(self.happened.left)
        return NOBODY, left == 0 and self.happened.ended, None, f"{left} left" if left else ""

    def _readable(self, incident: Incident) -> Found | None:
        last = incident is self.happened.incidents[-1]
        if incident.injection.victim != RECORDER and not last:
            return None
        if not is_recording(self.file):
            return READABLE, False, None, "it can not be read"
        recorder_died = incident.injection.victim == RECORDER and incident.died
        lost = torn_s(self.file, incident.at_ns) if recorder_died else missing_s(self.file)
        return READABLE, lost <= _LOST_S, lost, ""

    def _trial(self, incident: Incident) -> Found | None:
        if not (incident.injection.restarts and incident.died and incident.back):
            return None
        lost = trials_lost(self.file, incident.at_ns)
        return TRIAL, lost <= _LOST_TRIALS, lost + 1, f"the one that ran, and {lost} that had ended"


def torn_s(file: Path, at_ns: int) -> float:
    """How much of the time before the recorder's death a recording lacks."""
    newest_ns = max((row.time_ns for row in Recording(file).messages()), default=0)
    return max(0.0, (at_ns - newest_ns) / NS)


def missing_s(file: Path) -> float:
    """The longest time whose messages are missing on one topic."""
    often = (topic for topic in Recording(file).topics() if topic.hz >= _OFTEN_HZ)
    return max((topic.lost / topic.hz for topic in often), default=0.0)
