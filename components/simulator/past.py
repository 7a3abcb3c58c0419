"""What a camera or an encoder that lags still sees: the world a moment ago."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from components.simulator.wiring import Wiring
from docking.pinhole import Array, Camera

KEPT_S = 0.5
"""Longer than any latency."""


class Moment(NamedTuple):
    """The world at a time, as far as it is seen late."""

    time_ns: int
    pan_rad: float
    tilt_rad: float
    camera: Camera
    object_m: Array
    motion_pxps: Array
    """Of the image."""


class Past:
    """The newest moments of the world, kept only if something lags."""

    def __init__(self, wiring: Wiring, steps_hz: int) -> None:
        self._camera_ns = round(wiring.camera_latency_s * 1e9)
        self._encoder_ns = round(wiring.encoder_latency_s * 1e9)
        self._moments: deque[Moment] = deque(maxlen=round(KEPT_S * steps_hz))

    @property
    def is_kept(self) -> bool:
        """Whether something lags."""
        return self._camera_ns > 0 or self._encoder_ns > 0

    def add(self, moment: Moment) -> None:
        """The world after a step."""
        self._moments.append(moment)

    def seen(self, now: Moment) -> Moment:
        """What the camera shows now."""
        return self._at(now, self._camera_ns)

    def read(self, now: Moment) -> tuple[float, float]:
        """(pan_rad, tilt_rad) at which the encoders read now."""
        moment = self._at(now, self._encoder_ns)
        return moment.pan_rad, moment.tilt_rad

    def _at(self, now: Moment, latency_ns: int) -> Moment:
        """Between the two moments around a time; the oldest one if it is long ago."""
        if latency_ns == 0 or not self._moments:
            return now
        time_ns, after = now.time_ns - latency_ns, now
        for before in reversed(self._moments):
            if before.time_ns <= time_ns:
                return _between(before, after, time_ns)
            after = before
        return after


def _between(before: Moment, after: Moment, time_ns: int) -> Moment:
    if after.time_ns <= before.time_ns:
        return before
    share = (time_ns - before.time_ns) / (after.time_ns - before.time_ns)

    def mixed(a: float, b: float) -> float:
        return a + share * (b - a)

    old, new = before.camera, after.camera
    camera = Camera(
        mixed(old.x_m, new.x_m),
        mixed(old.y_m, new.y_m),
        mixed(old.z_m, new.z_m),
        mixed(old.yaw_rad, new.yaw_rad),
        mixed(old.tilt_rad, new.tilt_rad),
        new.focal_px,
    )
    angles = (mixed(before.pan_rad, after.pan_rad), mixed(before.tilt_rad, after.tilt_rad))
    return Moment(time_ns, *angles, camera, after.object_m, after.motion_pxps)
