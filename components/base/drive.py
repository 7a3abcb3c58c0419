"""The command in force, and every reason to stop."""

from __future__ import annotations

from dataclasses import dataclass, field

from components.base.arbiter import NOBODY, STALE, Decision
from components.base.backing import Backing
from components.base.motion import NS, STILL, Motion, limited
from components.base.ports import Params

GONE, GUARD, BUMPER, STOPPED, DEAD_MAN = "gone", "guard", "bumper", "stop", "dead-man"
"""Reasons for a stop, as `Applied.commander` names them."""
EARLY_NS = 30_000_000
"""A period of `tick` and its lateness: the stop is said before a command is too old, not after."""


@dataclass(slots=True)
class Drive:
    """What the base executes. One instance a run."""

    params: Params
    motion: Motion = STILL
    """In force."""
    commander: str = NOBODY
    """Whose it is, or why it is none."""
    answers_ns: int | None = None
    """Capture time of the frame that the newest command answers; None before the first."""
    bumper: bool = False
    guard: bool = False
    """As the device said last."""
    backing: Backing = field(init=False)
    """What is known of the way behind."""
    dead_man_ns: int = -1
    """Newest frame in which a person was known to hold the dead-man key; -1 = it is not held."""
    gone_ns: int = -1
    """When a component that the robot needs died: older frames do not move it."""
    stopped_ns: int | None = None
    """When a stop for want of a fresh command was last said; None while commands are fresh."""

    def __post_init__(self) -> None:
        """Nothing is known of the way behind."""
        self.backing = Backing(self.params)

    def apply(self, decision: Decision, time_ns: int) -> tuple[str, Motion]:
        """Put a decision in force, within the limits. Returns for whom, or why not, and what."""
        since_s = 1.0 if self.answers_ns is None else (decision.capture_ns - self.answers_ns) / NS
        reason = self._refusal(decision, time_ns)
        wish = STILL if reason else decision.motion
        self.motion = limited(wish, self.motion, since_s, self.params)
        self.answers_ns = max(decision.capture_ns, self.answers_ns or 0)
        if decision.commander != STALE:
            self.stopped_ns = None
        self.commander = reason or decision.commander
        return self.commander, self.motion

    def stop(self, reason: str) -> tuple[str, Motion]:
        """Stand still from now on. Returns why, and the motion."""
        self.motion, self.commander = STILL, reason
        return reason, STILL

    def check(self, time_ns: int) -> str | None:
        """Reason to say a stop now, between frames; None if there is none, or if it was said just now."""
        if self.answers_ns is None:
            return None
        if time_ns + EARLY_NS - self.answers_ns > self.params.max_age_s * NS:
            return self._repeated(time_ns)
        if self.guard:
            return GUARD if self.motion[:2] != (0.0, 0.0) else None
        return self._hindrance(self.motion, time_ns) or None

    def _repeated(self, time_ns: int) -> str | None:
        if self.stopped_ns is not None and time_ns - self.stopped_ns < self.params.repeat_s * NS:
            return None
        self.stopped_ns = time_ns
        return STALE

    def _refusal(self, decision: Decision, time_ns: int) -> str:
        if self.guard:
            return GUARD
        return GONE if decision.capture_ns <= self.gone_ns else self._hindrance(decision.motion, time_ns)

    def _hindrance(self, motion: Motion, time_ns: int) -> str:
        """Why this motion must not be; empty = it may, or it is none."""
        if self.bumper and motion.v_mps > 0.0:
            return BUMPER
        if self._needs_dead_man(motion) and not self._is_held(time_ns):
            return DEAD_MAN
        return self.backing.hindrance() if motion.v_mps < 0.0 else ""

    def _needs_dead_man(self, motion: Motion) -> bool:
        backwards, turns = motion.v_mps < 0.0, motion.omega_radps != 0.0
        return {"never": False, "reverse": backwards, "always": turns or motion.v_mps != 0.0}[self.params.dead_man]

    def _is_held(self, time_ns: int) -> bool:
        return self.dead_man_ns >= 0 and time_ns - self.dead_man_ns <= self.params.max_age_s * NS
