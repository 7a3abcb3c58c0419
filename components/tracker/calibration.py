"""Head steps at the start of a session that teach the focal length. Nothing is given beforehand."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from components.tracker.focal import NonsenseError, Sample, fit
from components.tracker.gaze import direction
from components.tracker.ports import Params

CROSS = ((0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
"""Steps of the fine pass, in units of step_rad, about the object."""
CORNER = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
"""Steps of the coarse pass, in units of one step towards the object: wherever it stands, they keep it in the image."""


@dataclass
class Calibration:
    """A coarse pass towards the object, then a fine one with the object in the middle.

    Five steps of some three frames each. An attempt fails when the object is lost, a step does not settle, or the
    pixels make no sense; after some failures the head rests for a while, then tries again.
    """

    focal_px: float = 0.0
    """0 while unknown."""
    coarse_px: float = 0.0
    """Of the coarse pass; 0 = it is still to be done."""
    pan_rad: float = 0.0
    """The steps go out from here."""
    tilt_rad: float = 0.0
    pan_step_rad: float = 0.0
    tilt_step_rad: float = 0.0
    step: int = -1
    """-1 = not begun."""
    waited: int = 0
    taken: int = 0
    failures: int = 0
    resume_ns: int = 0
    before: Sample = field(default_factory=Sample)
    samples: list[Sample] = field(default_factory=list)

    def aim(self, now: Sample, time_ns: int, at_rest: bool, params: Params) -> tuple[float, float]:
        """Take one frame with the object in it, and say where to look next: (pan_rad, tilt_rad)."""
        if self.step < 0:
            self._begin(now.pan_rad, now.tilt_rad)
        elif time_ns < self.resume_ns:
            pass
        elif not at_rest:
            self._begin(now.pan_rad, now.tilt_rad)
            self.coarse_px = 0.0
        elif self._settled(now, params):
            self._measure(now, params, time_ns)
        elif self.waited > params.step_patience_frames:
            self.fail(time_ns, params)
        self.waited += 1
        self.before = now
        return self._target()

    def fail(self, time_ns: int, params: Params) -> None:
        """Give this attempt up; the next begins where the head looks now, a step nearer to the object.

        So an object that the image's border cuts off, and whose centre is not seen, comes into the image by and by.
        """
        if self.step < 0 or time_ns < self.resume_ns:
            return
        self.failures += 1
        target = self._target()
        self.coarse_px = 0.0
        self._begin(*target)
        if self.failures % params.calibration_attempts == 0:
            self.resume_ns = time_ns + round(params.calibration_pause_s * 1e9)

    def lost(self, time_ns: int, params: Params) -> None:
        """The object is out of sight: begin anew where it is seen again."""
        if self.step > 0 or self.taken:
            self.fail(time_ns, params)
        self.step = -1

    def _begin(self, pan_rad: float, tilt_rad: float) -> None:
        self.pan_rad, self.tilt_rad = pan_rad, tilt_rad
        self.pan_step_rad = self.tilt_step_rad = 0.0
        self.step = self.waited = self.taken = 0
        self.samples = []

    def _target(self) -> tuple[float, float]:
        pattern = CROSS if self.coarse_px else CORNER
        pan, tilt = pattern[self.step]
        tilt_rad = self.tilt_rad + tilt * self.tilt_step_rad
        return self.pan_rad + pan * self.pan_step_rad, min(max(tilt_rad, 0.0), 0.5 * math.pi)

    def _settled(self, now: Sample, params: Params) -> bool:
        """At least one frame after the command, on the target's side of the way, and still."""
        pan_rad, tilt_rad = self._target()
        still = max(abs(now.pan_rad - self.before.pan_rad), abs(now.tilt_rad - self.before.tilt_rad))
        off = max(abs(now.pan_rad - pan_rad), abs(now.tilt_rad - tilt_rad))
        return self.waited > 1 and still < params.settled_rad and off < 0.5 * params.step_rad

    def _measure(self, now: Sample, params: Params, time_ns: int) -> None:
        self.samples.append(now)
        self.taken += 1
        if self.taken < params.samples_per_step:
            return
        if self.step == 0:
            self._orient(now, params.step_rad)
        self.step, self.waited, self.taken = self.step + 1, 0, 0
        if self.step == len(CROSS if self.coarse_px else CORNER):
            self._finish(now, params, time_ns)

    def _orient(self, now: Sample, step_rad: float) -> None:
        """The coarse steps go towards the object."""
        self.pan_step_rad = step_rad if self.coarse_px else -math.copysign(step_rad, now.u_px)
        self.tilt_step_rad = step_rad if self.coarse_px else math.copysign(step_rad, now.v_px)

    def _finish(self, now: Sample, params: Params, time_ns: int) -> None:
        self.step -= 1
        try:
            focal_px = fit(self.samples, params.residual_px)
        except NonsenseError:
            self.fail(time_ns, params)
            return
        if self.coarse_px:
            self.focal_px = focal_px
            return
        self.coarse_px = focal_px
        self._begin(*direction(now.u_px, now.v_px, now.pan_rad, now.tilt_rad, focal_px))
