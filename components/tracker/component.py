"""Keeps the object in the image centre: views and encoders in, aim and percept out, once per frame."""

from __future__ import annotations

import math

from components.tracker import ports
from components.tracker.core import Aim, Seen, State, Tuning, begun, follow
from components.tracker.height import at_share
from components.tracker.join import Reading, Sight
from components.tracker.snapshot import loaded, saved
from runtime.contract import Event, Output
from schemas.drive_pb2 import Applied
from schemas.head_pb2 import HeadCommand, HeadState
from schemas.percept_pb2 import Percept
from schemas.view_pb2 import View

FURTHEST_PX = 10_000.0
"""No image is larger."""
STEEPEST = 1_000.0
"""No measured slope is."""
LARGEST_RAD = 2.0 * math.pi
"""No encoder reads more."""
FASTEST = 10.0
"""No base moves at more m/s or rad/s."""


class Tracker:
    """PD control of pan and tilt with feed-forward, search, and the learning of the focal length."""

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._tuning = Tuning(params)
        self._latency_ns = round(params.base_latency_s * 1e9)
        self._shift_ns = round((params.encoder_latency_s - params.camera_latency_s) * 1e9)
        self._camera_ns = round(params.camera_latency_s * 1e9)
        self._state = begun(params)

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Aim and percept of each frame whose view and encoders are both known."""
        state = self._state
        if event.port == "applied":
            self._apply(event.message, event.time_ns)
            return ()
        if event.port == "view":
            state.join.sight(sight_of(event.message, event.capture_ns))
        elif event.port == "head":
            state.join.reading(reading_of(event.message, event.capture_ns))
        outputs: list[Output] = []
        for capture_ns, sight, head in state.join.ready(self._shift_ns):
            exposure_ns = sight.capture_ns - self._camera_ns
            aim = follow(state, sight, head, self._tuning, capture_ns - exposure_ns)
            outputs += self._outputs(aim, state.seen, capture_ns, exposure_ns)
        return tuple(outputs)

    def save(self) -> bytes:
        """Everything remembered, the focal length above all: a restarted tracker need not learn it again."""
        return saved(self._state)

    def load(self, state: bytes) -> None:
        """Go on from what `save` gave.

        Raises:
            ValueError: the bytes are something else.
        """
        self._state = loaded(State, state)

    def _apply(self, applied: Applied, time_ns: int) -> None:
        if abs(applied.v_mps) <= FASTEST and abs(applied.omega_radps) <= FASTEST:
            self._state.base.command(time_ns + self._latency_ns, applied.v_mps, applied.omega_radps)

    def _outputs(self, aim: Aim, seen: Seen, capture_ns: int, exposure_ns: int) -> tuple[Output, Output]:
        slope, tilt_rad = at_share(seen.slope, seen.depression_rad, self._tuning.params.height_share)
        percept = Percept(
            visible=seen.visible,
            slope=slope,
            pan_rad=seen.bearing_rad,
            tilt_rad=tilt_rad,
            capture_time_ns=exposure_ns,
            pan_error_px=seen.u_px,
            tilt_error_px=seen.v_px,
            focal_px=self._state.calibration.focal_px,
        )
        command = HeadCommand(
            pan_rad=aim.pan_rad,
            tilt_rad=aim.tilt_rad,
            pan_rate_radps=aim.pan_rate_radps,
            tilt_rate_radps=aim.tilt_rate_radps,
        )
        return Output("percept", percept, capture_ns), Output("aim", command, capture_ns)  # the way to the wheels first


def sight_of(view: View, capture_ns: int) -> Sight:
    """A view with only believable numbers in it."""
    seen = view.object_visible and abs(view.object_u_px) < FURTHEST_PX and abs(view.object_v_px) < FURTHEST_PX
    edge = seen and view.edge_visible and abs(view.edge_slope) < STEEPEST and abs(view.edge_v_px) < FURTHEST_PX
    return Sight(
        capture_ns,
        seen,
        view.object_u_px if seen else 0.0,
        view.object_v_px if seen else 0.0,
        edge,
        view.edge_slope if edge else 0.0,
        view.edge_v_px if edge else 0.0,
    )


def reading_of(head: HeadState, capture_ns: int) -> Reading:
    """Encoders, NaN where they can not be believed."""
    if abs(head.pan_rad) <= LARGEST_RAD and abs(head.tilt_rad) <= LARGEST_RAD:
        return Reading(capture_ns, head.pan_rad, head.tilt_rad)
    return Reading(capture_ns)
