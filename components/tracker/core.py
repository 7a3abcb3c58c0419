"""One frame of tracking: what was seen and where the head was, to where it shall look and what the pilot steers by."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from components.tracker.base_motion import BaseMotion, Limits
from components.tracker.calibration import Calibration
from components.tracker.drift import Drift, smoother
from components.tracker.focal import Sample
from components.tracker.gaze import direction, slope_at_centre
from components.tracker.join import Join, Reading, Sight
from components.tracker.ports import Params
from components.tracker.search import Search
from components.tracker.servo import Servo

HEADING_S = 0.5
"""How far ahead the side is judged to which an object is heading."""


class Aim(NamedTuple):
    """Angles at the frame's capture, and the rates from there on."""

    pan_rad: float
    tilt_rad: float
    pan_rate_radps: float = 0.0
    tilt_rate_radps: float = 0.0


@dataclass
class Seen:
    """The percept: what was last seen, and whether it counts."""

    visible: bool = False
    slope: float = 0.0
    bearing_rad: float = 0.0
    depression_rad: float = 0.0
    u_px: float = 0.0
    v_px: float = 0.0


@dataclass
class State:
    """Everything a tracker remembers, as plain values."""

    join: Join = field(default_factory=Join)
    base: BaseMotion = field(default_factory=BaseMotion)
    calibration: Calibration = field(default_factory=Calibration)
    search: Search = field(default_factory=Search)
    pan: Servo = field(default_factory=Servo)
    tilt: Servo = field(default_factory=Servo)
    pan_drift: Drift = field(default_factory=Drift)
    tilt_drift: Drift = field(default_factory=Drift)
    seen: Seen = field(default_factory=Seen)
    way_m: float = 0.0
    """Of the base when the object was last seen."""
    edgeless_frames: int = 0
    """Since the table edge was last seen."""
    edge_known: bool = False
    """Seen since the object was last found."""


def begun(params: Params) -> State:
    """State at the start of a session: the head looks home."""
    state = State()
    state.search.watch(0.0, params.home_tilt_rad, 1.0)
    return state


class Tuning:
    """What follows from the parameters, made once."""

    def __init__(self, params: Params) -> None:
        self.params = params
        self.limits = Limits(params.base_acceleration_mps2, params.base_turn_acceleration_radps2)
        self.smoother = smoother(params.drift_memory)


def follow(state: State, sight: Sight, head: Reading, tuning: Tuning, age_ns: int = 0) -> Aim:
    """Take one frame, oldest first; the percept is then in `state.seen`.

    Args:
        state: changed.
        sight: in the image.
        head: encoders at its exposure.
        tuning: the parameters.
        age_ns: from the exposure to the capture time of the frame that is answered.
    """
    params = tuning.params
    state.base.advance(sight.capture_ns - round(params.camera_latency_s * 1e9), tuning.limits)
    state.seen.visible = False
    if not head.readable:
        return Aim(state.search.pan_rad, state.search.tilt_rad)
    if not sight.object:
        return _lost(state, sight.capture_ns, params)
    if not state.calibration.focal_px:
        return _calibrate(state, sight, head, params)
    _perceive(state, sight, head, params)
    return _track(state, head, tuning, age_ns * 1e-9)


def _lost(state: State, time_ns: int, params: Params) -> Aim:
    if state.search.frames == params.patience_frames:
        state.pan.forget()
        state.tilt.forget()
        state.pan_drift.forget()
        state.tilt_drift.forget()
        state.edge_known = False
        if not state.calibration.focal_px:
            state.calibration.lost(time_ns, params)
    return Aim(*state.search.aim(time_ns, params))


def _calibrate(state: State, sight: Sight, head: Reading, params: Params) -> Aim:
    sample = Sample(head.pan_rad, head.tilt_rad, sight.u_px, sight.v_px)
    pan_rad, tilt_rad = state.calibration.aim(sample, sight.capture_ns, state.base.at_rest, params)
    state.search.watch(pan_rad, tilt_rad, -sight.u_px)
    return Aim(pan_rad, tilt_rad)


def _perceive(state: State, sight: Sight, head: Reading, params: Params) -> None:
    seen, focal_px = state.seen, state.calibration.focal_px
    bearing_rad, depression_rad = direction(sight.u_px, sight.v_px, head.pan_rad, head.tilt_rad, focal_px)
    seen.bearing_rad, seen.depression_rad = bearing_rad, depression_rad
    seen.u_px, seen.v_px = sight.u_px, sight.v_px
    if sight.edge:
        off_axis_rad = bearing_rad - head.pan_rad
        view = (sight.slope, sight.u_px, sight.edge_v_px, head.tilt_rad, focal_px, off_axis_rad, depression_rad)
        seen.slope = slope_at_centre(*view) if params.slope_at_centre else sight.slope
        state.edgeless_frames, state.edge_known = 0, True
    else:
        state.edgeless_frames += 1
    seen.visible = state.edge_known and state.edgeless_frames <= params.edge_memory_frames


def _track(state: State, head: Reading, tuning: Tuning, age_s: float) -> Aim:
    seen, params = state.seen, tuning.params
    (pan_rate_radps, tilt_rate_radps), (pan_since_rad, tilt_since_rad) = _rates(state, tuning, age_s)
    pan_error_rad = seen.bearing_rad - head.pan_rad
    tilt_error_rad = seen.depression_rad - head.tilt_rad
    pan = head.pan_rad + state.pan.correction_rad(pan_error_rad, params.pan_gain_p, params.pan_gain_d)
    tilt = head.tilt_rad + state.tilt.correction_rad(tilt_error_rad, params.tilt_gain_p, params.tilt_gain_d)
    state.search.watch(pan, tilt, pan_error_rad + pan_rate_radps * HEADING_S)
    if not params.feed_forward:
        return Aim(pan, tilt)
    lag_s = params.head_lag_s
    pan, tilt = pan + pan_since_rad, tilt + tilt_since_rad
    return Aim(pan + pan_rate_radps * lag_s, tilt + tilt_rate_radps * lag_s, pan_rate_radps, tilt_rate_radps)


def _rates(state: State, tuning: Tuning, age_s: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """How the object's direction (pan, tilt) moves, as far as the base's commands tell.

    Returns:
        mean rates from the capture to the next one, and the way since the exposure.
    """
    base, frame_s = state.base, tuning.params.frame_s
    way_m, state.way_m = base.way_m - state.way_m, base.way_m
    state.pan_drift.update(state.seen.bearing_rad + base.heading_rad, way_m, tuning.smoother)
    state.tilt_drift.update(state.seen.depression_rad, way_m, tuning.smoother)
    since_m, since_rad = base.ahead(age_s, tuning.limits) if age_s else (0.0, 0.0)
    next_m, turn_rad = base.ahead(age_s + frame_s, tuning.limits)
    next_m, turn_rad = next_m - since_m, turn_rad - since_rad
    pan, tilt = state.pan_drift.rad_per_m, state.tilt_drift.rad_per_m
    rates = ((pan * next_m - turn_rad) / frame_s, tilt * next_m / frame_s)
    return rates, (pan * since_m - since_rad, tilt * since_m)
