"""The command in force, and every reason to stop."""

from __future__ import annotations

from dataclasses import dataclass

from components.base.arbiter import NOBODY, STALE, Decision
from components.base.motion import NS, STILL, Motion, limited
from components.base.ports import Params

GONE, GUARD, BUMPER, STOPPED = "gone", "guard", "bumper", "stop"
"""Reasons for a stop, as `Applied.commander` names them."""


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
    gone_ns: int = -1
    """When a component that the robot needs died: older frames do not move it."""
    stopped_ns: int | None = None
    """When a stop for want of a fresh command was last said; None while commands are fresh."""

    def apply(self, decision: Decision) -> tuple[str, Motion]:
        """Put a decision in force, within the limits. Returns for whom, or why not, and what."""
        since_s = 1.0 if self.answers_ns is None else (decision.capture_ns - self.answers_ns) / NS
        reason = self._hindrance(decision)
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
        if time_ns - self.answers_ns > self.params.max_age_s * NS:
            return self._repeated(time_ns)
        if self.guard and self.motion[:2] != (0.0, 0.0):
            return GUARD
        return BUMPER if self.bumper and self.motion.v_mps > 0.0 else None

    def _repeated(self, time_ns: int) -> str | None:
        if self.stopped_ns is not None and time_ns - self.stopped_ns < self.params.repeat_s * NS:
            return None
        self.stopped_ns = time_ns
        return STALE

    def _hindrance(self, decision: Decision) -> str:
        if self.guard:
            return GUARD
        if decision.capture_ns <= self.gone_ns:
            return GONE
        return BUMPER if self.bumper and decision.motion.v_mps > 0.0 else ""
