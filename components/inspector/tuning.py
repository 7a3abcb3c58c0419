"""What the steps of the head say about the tracker's parameters."""

from __future__ import annotations

import math

from components.inspector.gains import WORTH, Gains, Loop, best, error_rad
from components.inspector.judgement import Change, Judgement, Verdict, unknown
from components.inspector.latency import Fit, Records, Servos, fit
from components.inspector.ports import Params
from components.inspector.servo import ramp_lag_s

TRACKER = "components.tracker"
AGREES_S = 0.02
"""A latency is right within this."""
WORST_PX, WORST_RAD = 1.5, math.radians(0.5)
"""Larger residuals mean that the head does not move as a first-order lag."""


def judge(records: Records, params: Params) -> list[Judgement]:
    """Latencies, pixels per degree, lag and gains."""
    servos = Servos(params.servo_cycle_s, params.pan_rate_radps, params.tilt_rate_radps)
    found = fit(records, servos, params.width_px)
    if not 0.8 < found.encoder_gain < 1.2 or found.image_rms_px > WORST_PX or found.encoder_rms_rad > WORST_RAD:
        words = (
            f"image and encoders do not follow the head (gain {found.encoder_gain:.2f}, residuals "
            f"{found.image_rms_px:.1f} px, {math.degrees(found.encoder_rms_rad):.2f} deg): berth check hardware first"
        )
        return [unknown("head", words)]
    lag_s = ramp_lag_s(found.lag_s, params.servo_cycle_s)
    return [
        _time("camera latency", found.camera_latency_s, params.camera_latency_s, "camera_latency_s"),
        _time("encoder latency", found.encoder_latency_s, params.encoder_latency_s, "encoder_latency_s"),
        _time("head lag", lag_s, params.head_lag_s, "head_lag_s"),
        Judgement("pixels per degree", Verdict.GOOD, "", math.radians(found.focal_px), "px/deg"),
        *_gains("pan", Gains(params.pan_gain_p, params.pan_gain_d), found, params.pan_rate_radps, params),
        *_gains("tilt", Gains(params.tilt_gain_p, params.tilt_gain_d), found, params.tilt_rate_radps, params),
    ]


def _time(thing: str, measured_s: float, in_force_s: float, param: str) -> Judgement:
    measured_s = round(measured_s, 3)
    if abs(measured_s - in_force_s) <= AGREES_S:
        return Judgement(thing, Verdict.GOOD, f"{in_force_s:g} s in force", measured_s, "s")
    words = f"{in_force_s:g} s in force"
    return Judgement(thing, Verdict.WRONG, words, measured_s, "s", TRACKER, param, Change.SET, measured_s)


def _gains(axis: str, used: Gains, found: Fit, rate_radps: float, params: Params) -> list[Judgement]:
    """Judged without feed-forward, whose part is the robot's own motion; encoders are taken at the exposure."""
    noise_rad = found.image_rms_px / found.focal_px
    loop = Loop(found.lag_s, found.camera_latency_s, rate_radps, params.frame_s, noise_rad)
    wanted = best(loop)
    here_deg, there_deg = (math.degrees(error_rad(gains, loop)) for gains in (used, wanted))
    words = (
        f"error {here_deg:.2f} deg with P {used.p:g}, D {used.d:g}; {there_deg:.2f} with P {wanted.p:g}, D {wanted.d:g}"
    )
    if here_deg <= WORTH * there_deg:
        return [Judgement(f"{axis} gains", Verdict.GOOD, words, here_deg, "deg")]
    return [
        Judgement(f"{axis} gain {letter.upper()}", Verdict.WRONG, words, value, "", TRACKER, f"{axis}_gain_{letter}",
                  Change.SET, value)
        for letter, value in zip("pd", wanted, strict=True)
    ]  # fmt: skip
