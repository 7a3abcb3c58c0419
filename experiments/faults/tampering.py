"""Folds under a virtual clock, one fault after another: messages lost, late and doubled, pauses, deaths, restarts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from experiments.faults.lessons import POLICY, SNAPSHOT, forgotten
from experiments.faults.lessons import TRIAL as TRIAL_KEY
from experiments.faults.motion import NS, Robot, late_s, stale_s, stop_s
from experiments.faults.plan import FOLDS, LEARNER, Injection
from experiments.faults.timeline import COMMAND, TRUTH, Moved, Timeline, Told
from experiments.faults.verdict import BRAKES, FRESH, REASON, TRIAL, WORD, Verdict
from experiments.faults.virtual import Virtual
from experiments.watched import LAUNCH
from runtime.hosted import Sample
from runtime.launch import load
from runtime.messages import message_class

WITHOUT_PROCESSES = 24
"""Injections in one session."""
_TAMPERED = ("lose", "delay", "double")
_BEGIN_S, _RESTART_S, _BACK_S, _ALONE_S = 3.0, 3.0, 20.0, 1.2
_LONGEST_GAP_S = 2.0
STEP_S = 1.0 / 64.0


@dataclass(frozen=True)
class Placed:
    """An injection and when it is done, session time."""

    injection: Injection
    at_ns: int

    @property
    def over_ns(self) -> int:
        """When the fault itself has ended."""
        done = self.injection
        return self.at_ns + round((_RESTART_S if done.restarts else done.lasts_s) * NS)


def placed(seed: int, count: int) -> Sequence[Placed]:
    """One session: passing faults, some deaths of the learner, and at last the death of somebody."""
    rng = np.random.default_rng([seed, 12])
    found, at_s = [], _BEGIN_S
    for number in range(count):
        injection = _drawn(rng) if number < count - 1 else Injection("kill", str(rng.choice(FOLDS[:5])), alone=True)
        at_s += float(rng.uniform(0.2, _LONGEST_GAP_S))
        found.append(Placed(injection, round(at_s * NS)))
        at_s = found[-1].over_ns / NS
    return found


def _drawn(rng: np.random.Generator) -> Injection:
    """What base says to its device goes over its own wire: neither lost nor late are faults that base could see."""
    if rng.random() < 0.1:
        return Injection("kill", LEARNER)
    fault = str(rng.choice((*_TAMPERED, "pause")))
    victims = [name for name in FOLDS if name != "base" or fault in ("double", "pause")]
    lasts_s = float(np.exp(rng.uniform(np.log(0.1), np.log(3.0))))
    return Injection(fault, str(rng.choice(victims)), lasts_s=lasts_s)


class Tampered:
    """A session that is run and judged."""

    def __init__(self, seed: int, robot: Robot, count: int = WITHOUT_PROCESSES, overrides: Sequence[str] = ()) -> None:
        self._robot = robot
        self._placed = placed(seed, count)
        self._virtual = Virtual(load(LAUNCH, overrides, clock="real", seed=seed), seed)
        self._virtual.hear = self._hear
        self._virtual.ways = self._ways
        self._active: list[Placed] = []
        self._truths: list[Moved] = []
        self._commands: list[Told] = []
        self._ended: list[tuple[int, int]] = [(0, 0)]
        """(capture time, training trials that had ended)."""
        self._learned_ns: list[int] = []
        """When the learner that runs has said a policy."""
        self._known_until_ns = 0
        self._snapshot: bytes | None = None
        self._forgotten: dict[int, int] = {}
        """When the learner died -> trials that it has lost."""

    def run(self) -> None:
        """To the end, and until the robot must be at rest."""
        for one in self._placed:
            self._virtual.at(one.at_ns, partial(self._begin, one))
            self._virtual.at(one.over_ns, partial(self._end, one))
        last_ns = self._placed[-1].at_ns
        self._virtual.run(last_ns + round(_ALONE_S * NS))
        self._virtual.stop()

    def verdicts(self, experiment: str, seed: int) -> Iterator[Verdict]:
        """What each injection has shown."""
        line = Timeline(self._truths, self._commands)
        ends_ns = [*(one.at_ns for one in self._placed[1:]), self._virtual.now_ns]
        for number, (one, end_ns) in enumerate(zip(self._placed, ends_ns, strict=True)):
            done = one.injection
            for promise, measured, limit in self._measured(line, one, end_ns):
                held = measured <= limit
                note = "" if held else f"more than {limit:.3f}"
                yield Verdict(
                    experiment, seed, "in-process", number, done.fault, done.victim, promise, held, measured, note
                )

    def _measured(self, line: Timeline, one: Placed, end_ns: int) -> Iterator[tuple[str, float, float]]:
        """(promise, what was measured, what it may be)."""
        robot, base = self._robot, one.injection.victim == "base"
        after_s = stop_s(robot, line, one.at_ns)
        if after_s is not None:
            yield BRAKES, after_s, robot.max_age_s + robot.latency_s + STEP_S
        stale = None if base else stale_s(robot, line, one.at_ns, end_ns)
        if stale is not None:
            yield WORD, stale, 0.0
        yield FRESH, late_s(robot, line, one.at_ns, end_ns, deaf=base), STEP_S
        if one is not self._placed[-1]:
            yield REASON, self._back_s(one), _BACK_S
        if one.at_ns in self._forgotten:
            yield TRIAL, self._forgotten[one.at_ns] + 1, 1

    def _back_s(self, one: Placed) -> float:
        """How long after a fault the robot moved again; 0 if the session was over too soon to tell."""
        moved = (truth.at_ns for truth in self._truths if truth.at_ns > one.over_ns and not truth.still)
        return (next(moved, one.over_ns) - one.over_ns) / NS

    def _begin(self, one: Placed) -> None:
        done = one.injection
        if done.fault == "pause":
            self._virtual.sleep(done.victim, one.over_ns)
        elif done.fault in _TAMPERED:
            self._active.append(one)
        else:
            self._virtual.kill(done.victim)
            if done.restarts:
                found = forgotten(self._ended, self._learned_ns, self._known_until_ns, one.at_ns)
                self._forgotten[one.at_ns] = found

    def _end(self, one: Placed) -> None:
        if one in self._active:
            self._active.remove(one)
        if one.injection.restarts:
            self._virtual.seat(LEARNER, self._snapshot)
            self._learned_ns.clear()
            self._known_until_ns = self._virtual.now_ns

    def _ways(self, name: str, _: Sample) -> Sequence[int]:
        active = next((one for one in self._active if one.injection.victim == name), None)
        if active is None:
            return (0,)
        late_ns = active.over_ns - self._virtual.now_ns
        return {"lose": (), "delay": (late_ns,), "double": (0, late_ns)}[active.injection.fault]

    def _hear(self, sample: Sample) -> None:
        message = self._decoded(sample)
        if sample.key == TRUTH:
            self._truths.append(Moved(sample.capture_ns, message.v_mps, message.omega_radps))
        elif sample.key == COMMAND:
            now_ns = self._virtual.now_ns
            self._commands.append(Told(sample.capture_ns, now_ns, message.v_mps, message.omega_radps))
        elif sample.key == TRIAL_KEY:
            self._ended.append((sample.capture_ns, message.ended))
        elif sample.key == POLICY:
            self._learned_ns.append(sample.capture_ns)
        elif sample.key == SNAPSHOT:
            self._snapshot, self._known_until_ns = sample.payload, sample.capture_ns

    @staticmethod
    def _decoded(sample: Sample) -> Any:
        kind = message_class(sample.schema) if sample.key in (TRUTH, COMMAND, TRIAL_KEY) else None
        return None if kind is None else kind.FromString(sample.payload)
