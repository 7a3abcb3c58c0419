"""Small motions that tell how a robot is wired: parameters and ports. For `berth check hardware`, `berth tune head`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from docking.angles import DEG
from runtime.contract import Input, Kind, Port
from runtime.params import between, not_negative, one_of, positive
from schemas.drive_pb2 import Applied, BaseState, Drive
from schemas.head_pb2 import HeadCommand, HeadState
from schemas.inspection_pb2 import Finding
from schemas.session_pb2 import SessionEnd
from schemas.trial_pb2 import Trial
from schemas.view_pb2 import View


@dataclass(frozen=True)
class Params:
    """Parameters of this component. All motions stay below 5 cm and 10 deg."""

    stage: str = one_of("facing", "facing", "fingertips", "head")
    """What is looked at: head and wheels, 2 m before the object; lift, fingers and beams, the object before the finger
    tips; or how fast head, camera and encoders answer."""
    pan_step_rad: float = between(4 * DEG, 1 * DEG, 5 * DEG)
    """Pan goes this far to both sides."""
    tilt_step_rad: float = between(3 * DEG, 1 * DEG, 5 * DEG)
    """As above; the object stands near the image's lower border while the head is at its zero."""
    turn_rate_radps: float = between(5 * DEG, 1 * DEG, 8 * DEG)
    """The robot turns by this for a second."""
    speed_mps: float = between(0.04, 0.01, 0.045)
    """It drives at this for a second."""
    creep_mps: float = between(0.02, 0.005, 0.03)
    """Speed at which the object comes between the beams, for at most creep_m."""
    creep_m: float = between(0.045, 0.01, 0.045)
    """As above."""
    nearby_m: float = positive(2.0)
    """Roughly how far off the object stands; units are wrong by a factor of ten at least."""
    zero_rad: float = positive(7 * DEG)
    """The head must read less than this before it is moved: who stands at zero goes nowhere, whatever the signs."""
    wait_s: float = positive(12.0)
    """Longest wait for head and base in the beginning: a robot is connected to in 2 s, a VC-C4 is busy for 5 s after it
    has been switched on."""
    lost_frames: int = between(4, 1, 40)
    """Frames without the object, or with the robot stopped by base, that end the check."""
    width_px: int = positive(320)
    """Of the image."""
    pan_rate_radps: float = positive(800 * 0.1125 * DEG)
    """Fastest pan, as head's."""
    tilt_rate_radps: float = positive(622 * 0.1125 * DEG)
    """Fastest tilt, as head's."""
    servo_cycle_s: float = positive(0.005)
    """The head's motors are taken for first-order lags that are computed this often: more often than any servo looks at
    its target. What a slower one lets pass, up to its cycle, counts as latency."""
    frame_s: float = positive(0.125)
    """Time between frames, as tracker's."""
    camera_latency_s: float = not_negative(0.0)
    """In force, as tracker's."""
    encoder_latency_s: float = not_negative(0.0)
    """In force, as tracker's."""
    head_lag_s: float = not_negative(0.03)
    """In force, as tracker's."""
    pan_gain_p: float = between(0.9, 0.01, 1.0)
    """In force, as tracker's."""
    pan_gain_d: float = between(0.05, 0.0, 0.5)
    """As above."""
    tilt_gain_p: float = between(0.9, 0.01, 1.0)
    """As above."""
    tilt_gain_d: float = between(0.05, 0.0, 0.5)
    """As above."""
    beams_swapped: bool = False
    """In force, as base's."""


INPUTS: Mapping[str, Input] = {
    "view": Port(View, Kind.STATE, hz=8, per_frame=True),
    "head": Port(HeadState, Kind.STATE, hz=8, per_frame=True),
    "base": Port(BaseState, Kind.STATE, hz=8, per_frame=True),
    "applied": Port(Applied, Kind.STATE, hz=8),
}
OUTPUTS: Mapping[str, Port] = {
    "aim": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True, on=("view",)),
    "drive": Port(Drive, Kind.COMMAND, hz=8, per_frame=True, on=("view",)),
    "trial": Port(Trial, Kind.EVENT, hz=8, per_frame=True, on=("view",)),
    "finding": Port(Finding, Kind.EVENT, on=("view",)),
    "end": Port(SessionEnd, Kind.EVENT, on=("view",)),
}
