"""Keeps the object in the image centre; publishes the percept: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from docking.angles import DEG
from runtime.contract import Input, Kind, Port
from runtime.params import ConfigurationError, between, positive
from schemas.drive_pb2 import Applied
from schemas.head_pb2 import HeadCommand, HeadState
from schemas.percept_pb2 import Percept
from schemas.view_pb2 import View


@dataclass(frozen=True)
class Params:
    """Parameters of this component. Those without a source were tuned in simulation, `benchmarks/tracking.py`."""

    pan_gain_p: float = between(0.9, 0.01, 1.0)
    """Share of the pan error that one frame's command takes away."""
    pan_gain_d: float = between(0.05, 0.0, 0.5)
    """Times the growth of the pan error since the last frame. P + D <= 1: then the head never overshoots."""
    tilt_gain_p: float = between(0.9, 0.01, 1.0)
    """As pan_gain_p."""
    tilt_gain_d: float = between(0.05, 0.0, 0.5)
    """As pan_gain_d."""
    feed_forward: bool = True
    """The aim carries the rates at which the object is predicted to move; false = the paper's PD alone."""
    drift_memory: float = between(0.6, 0.0, 0.99)
    """Weight of an older frame relative to the next newer one in the line-of-sight drift (a fading-memory filter)."""
    frame_s: float = positive(0.125)
    """Time between frames. Martinez-Marin and Duckett 2005, Table I: Ts."""
    head_lag_s: float = between(0.03, 0.0, 0.5)
    """Lag of the head behind a moving target, led by feed_forward."""
    camera_latency_s: float = between(0.0, 0.0, 0.5)
    """An image's capture time is this much later than its exposure. `berth tune head` measures it, and the next one."""
    encoder_latency_s: float = between(0.0, 0.0, 0.5)
    """The encoders' capture time is this much later than they were read."""

    base_latency_s: float = between(0.03, 0.0, 1.0)
    """From `applied` to the base's first reaction."""
    base_acceleration_mps2: float = positive(0.3)
    """Of the base."""
    base_turn_acceleration_radps2: float = positive(100 * DEG)
    """Of the base."""

    slope_at_centre: bool = True
    """The percept's slope is the one that the edge would show at the image centre, so that it is exactly
    tan(beta) sin(tilt); false = as measured in the image, which reads beta too large where the edge is low."""
    height_share: float = between(1.0, 0.2, 5.0)
    """Height of the camera over the object, as a share of that of the robot that the task was shown to: the tangent of
    the tilt that this robot reads at the pick-up over that of the task's. Percepts are given as that robot reads them,
    so that robots which differ can share a policy."""
    edge_memory_frames: int = between(3, 0, 80)
    """Frames without a table edge for which the last slope still counts."""

    step_rad: float = between(4 * DEG, 1 * DEG, 10 * DEG)
    """Head steps that teach the focal length: a tenth of the image, eighty times the encoder's resolution."""
    settled_rad: float = positive(0.3 * DEG)
    """The head rests when its encoders move less than this between frames: above the encoders' noise."""
    step_patience_frames: int = between(12, 3, 200)
    """A step that has not settled after this long fails the attempt."""
    samples_per_step: int = between(2, 1, 20)
    """Frames measured at each step."""
    residual_px: float = positive(3.0)
    """An attempt whose pixels disagree with one focal length by more than this (root mean square) is nonsense."""
    calibration_attempts: int = between(3, 1, 100)
    """Failed attempts after which the head rests for calibration_pause_s."""
    calibration_pause_s: float = positive(20.0)
    """As above."""

    home_tilt_rad: float = between(15 * DEG, 0.0, 1.57)
    """Where the head looks first, at pan 0: at an object 1.7 m away, 0.45 m below the camera."""
    patience_frames: int = between(4, 0, 80)
    """Frames without the object for which the head stays; then it searches."""
    search_rate_radps: float = positive(50 * DEG)
    """Fastest motion of a search: within the unit's 70 deg/s, and 7 px of blur in an exposure of 10 ms."""
    search_near_rad: float = between(25 * DEG, 0.0, 3.14)
    """The search first looks this far to the side where the object was heading, then as far to the other side."""
    search_pan_rad: float = between(100 * DEG, 0.01, 3.14)
    """Then it sweeps the pan over +- this. VC-C4: +-100 deg."""
    search_tilt_high_rad: float = between(58 * DEG, 0.0, 1.57)
    """Largest tilt of the sweep's rows; the first is home_tilt_rad."""
    search_row_rad: float = positive(18 * DEG)
    """Between two rows: half the field of view of 320x240 pixels at 364 pixels per radian."""

    def __post_init__(self) -> None:
        """Check what no single field shows."""
        for axis, total in (("pan", self.pan_gain_p + self.pan_gain_d), ("tilt", self.tilt_gain_p + self.tilt_gain_d)):
            if total > 1.0:
                raise ConfigurationError(f"tracker.params.{axis}_gain_p + {axis}_gain_d must be <= 1; got {total:g}")


INPUTS: Mapping[str, Input] = {
    "view": Port(View, Kind.STATE, hz=8, per_frame=True),
    "head": Port(HeadState, Kind.STATE, hz=8, per_frame=True),
    "applied": Port(Applied, Kind.STATE, hz=8),
}
OUTPUTS: Mapping[str, Port] = {
    "percept": Port(Percept, Kind.STATE, hz=8, per_frame=True, on=("view", "head")),
    "aim": Port(HeadCommand, Kind.COMMAND, hz=8, per_frame=True, on=("view", "head")),
}
