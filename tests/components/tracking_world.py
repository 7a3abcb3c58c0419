"""A small world for the tracker: plant, pinhole camera, head with lag and slew. No images, no bus."""

import math

import numpy as np

from components.tracker.component import Tracker
from components.tracker.ports import Params
from docking import plant
from docking.pinhole import Mount
from runtime.contract import Event
from schemas.drive_pb2 import Applied
from schemas.head_pb2 import HeadState
from schemas.view_pb2 import View

FRAME_NS = 125_000_000
STEP_S = 1 / 64
EDGE = np.array([-0.05, 0.0, -0.07])
ALONG_EDGE = np.array([0.0, 1.0, 0.0])
HALF_IMAGE = (160.0, 120.0)
OBJECT = np.array([0.066, 0.115])


class World:
    """One robot in front of an object, followed by a tracker; `frame` goes on by 0.125 s."""

    def __init__(self, beta=0.2, alpha=0.1, d=1.5, focal=364.0, noise_px=0.0, pan=0.0, tilt=0.26, **params):
        self.pose = plant.pose(beta, alpha, d)
        self.focal, self.noise_px = focal, noise_px
        self.mirrored_pan = False
        self.hidden = False
        self.edge_hidden = False
        self.head_lag_s = 0.04
        self.pan, self.tilt = pan, tilt
        self.v = self.omega = 0.0
        self.drive = (0.0, 0.0)
        self.now_ns = 0
        self.rng = np.random.default_rng(1)
        self.tracker = Tracker(Params(**params), 0)

    @property
    def truth(self):
        """(beta, alpha, d)."""
        return plant.observe(*self.pose)

    @property
    def camera(self):
        return Mount().camera(self.pose, self.pan, self.tilt, self.focal)

    @property
    def object_px(self):
        u, v = self.camera.project(np.zeros((1, 3)))[0]
        return float(u), float(v)

    def view(self):
        """The middle of what the image's border leaves of the object."""
        centre_px = self.object_px
        size_px = self.focal * OBJECT / math.hypot(self.truth[2], 0.45)
        low = [max(c - s / 2, -h) for c, s, h in zip(centre_px, size_px, HALF_IMAGE, strict=True)]
        high = [min(c + s / 2, h) for c, s, h in zip(centre_px, size_px, HALF_IMAGE, strict=True)]
        if self.hidden or not all(a + 4 < b for a, b in zip(low, high, strict=True)):
            return View()
        u, v = ((a + b) / 2 for a, b in zip(low, high, strict=True))
        slope = self.camera.slope(EDGE, ALONG_EDGE)
        edge_u, edge_v = self.camera.project(EDGE[None])[0]
        du, dv = self.noise_px * self.rng.standard_normal(2)
        return View(
            object_visible=True,
            object_u_px=u + du,
            object_v_px=v + dv,
            edge_visible=not self.edge_hidden,
            edge_slope=slope,
            edge_v_px=edge_v + slope * (u - edge_u),
        )

    def head_state(self):
        step = math.radians(0.1125) if self.noise_px else 1e-12
        pan = -self.pan if self.mirrored_pan else self.pan
        return HeadState(pan_rad=round(pan / step) * step, tilt_rad=round(self.tilt / step) * step)

    def event(self, port, message):
        return Event(self.now_ns, port, message, self.now_ns)

    def frame(self, v=0.0, omega=0.0):
        """The tracker answers this frame, then the world moves on; returns (aim, percept)."""
        outputs = self.tracker.handle(self.event("head", self.head_state()))
        outputs += self.tracker.handle(self.event("view", self.view()))
        answers = {output.port: output.message for output in outputs}
        assert len(answers) == len(outputs) == 2
        self.tracker.handle(self.event("applied", Applied(v_mps=v, omega_radps=omega)))
        self._move(answers["aim"], v, omega)
        return answers["aim"], answers["percept"]

    def until(self, condition, frames, **drive):
        """Go on until `condition(percept)`; returns the percept."""
        for _ in range(frames):
            _, percept = self.frame(**drive)
            if condition(percept):
                return percept
        raise AssertionError(f"not within {frames} frames")

    def _move(self, aim, v, omega):
        sign = -1.0 if self.mirrored_pan else 1.0
        for i in range(8):
            if i == 2:
                self.drive = (v, omega)
            self.v = _towards(self.v, self.drive[0], 0.3 * STEP_S)
            self.omega = _towards(self.omega, self.drive[1], math.radians(100) * STEP_S)
            self.pose = plant.advance(*self.pose, self.v, self.omega, STEP_S)
            age_s = (i + 1) * STEP_S
            pan_goal = sign * min(max(aim.pan_rad + aim.pan_rate_radps * age_s, -1.75), 1.75)
            tilt_goal = min(max(aim.tilt_rad + aim.tilt_rate_radps * age_s, 0.0), math.pi / 2)
            share = 1.0 - math.exp(-STEP_S / self.head_lag_s)
            self.pan = _towards(self.pan, self.pan + share * (pan_goal - self.pan), math.radians(90) * STEP_S)
            self.tilt = _towards(self.tilt, self.tilt + share * (tilt_goal - self.tilt), math.radians(70) * STEP_S)
        self.now_ns += FRAME_NS


def _towards(value, goal, most):
    return value + min(max(goal - value, -most), most)
