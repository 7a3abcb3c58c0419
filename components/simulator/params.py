"""Every number of the simulated world. Standard library and the task only, so that a launch check costs nothing."""

from __future__ import annotations

from dataclasses import dataclass, field

from components.simulator.wiring import Wiring
from docking.angles import DEG
from docking.task import Task
from runtime.params import between, not_negative, one_of, positive, ruled

SUBSTEPS_HZ = 64
"""The world advances in steps of 1/64 s: a whole number of nanoseconds."""


@dataclass(frozen=True)
class Params:
    """Parameters of the simulated world."""

    task: Task = field(default_factory=Task)
    """For the ranges of the starts `full`."""
    clock: str = one_of("lockstep", "lockstep", "real")
    """The session's clock. lockstep: the world waits for its commands; real: it follows the tick."""
    frame_hz: int = ruled(8, "a divisor of 64", lambda value: value > 0 and SUBSTEPS_HZ % value == 0)
    """Camera frames a second. Paper, Table I: Ts = 0.125 s."""
    begins: str = one_of("start", "start", "goal", "facing", "fingertips")
    """Where a run begins: at a start, or where a person puts the robot: in the pick-up pose to show the goal; to be
    checked, 2 m before the object, or with the object before its finger tips and the lift down (`beginning.py`)."""
    wiring: Wiring = field(default_factory=Wiring)
    """What is connected wrongly, for `berth check hardware` to find."""
    starts: str = one_of("demo", "demo", "full")
    """Which starts the robot is placed at (`docking.starts`)."""
    starts_seed: int = not_negative(2005)
    """Of the evaluation's starts, apart from the session's seed so that sessions share their starts."""

    acceleration_mps2: float = positive(0.3)
    """Base, speeding up and braking. Pioneer/PeopleBot manual: default translational acceleration."""
    angular_acceleration_radps2: float = positive(100 * DEG)
    """Base, turning. Pioneer/PeopleBot manual: default rotational acceleration."""
    speed_limit_mps: float = positive(0.8)
    """A command beyond it is refused and brakes. PeopleBot data sheet: top speed."""
    turn_limit_radps: float = positive(150 * DEG)
    """As above, for turning. PeopleBot data sheet."""
    command_latency_s: float = between(0.03, 0.0, 1.0)
    """From a command's arrival to its effect, rounded up to 1/64 s: serial line and the base's 50 ms cycle. Ours."""
    watchdog_s: float = positive(0.3)
    """The base brakes by itself if no command came for this long. Ours, as base's own limit."""
    odometry_scale: float = not_negative(0.01)
    """Standard deviation of the odometry's scale errors, one draw for distance and one for turns per run. Ours."""
    speed_noise_mps: float = not_negative(0.002)
    """Standard deviation of the reported speed. Ours."""
    turn_noise_radps: float = not_negative(0.3 * DEG)
    """Standard deviation of the reported turn rate. Ours."""

    robot_radius_m: float = positive(0.18)
    """Front of the robot ahead of the axle, a circle about the axle. PeopleBot: 0.38 m wide."""
    edge_offset_m: float = positive(0.05)
    """Table edge on this side of the object's centre. Ours."""
    table_width_m: float = positive(2.4)
    """Along the edge, the object in the middle. Ours."""
    table_depth_m: float = positive(0.8)
    """Away from the edge. Ours."""
    wall_behind_m: float = not_negative(0.0)
    """A wall along the table's edge, this far from the object on the robot's side; 0 = none."""
    rear_reach_m: float = not_negative(0.0)
    """Longest free way that the range sensor behind tells of; 0 = the robot has no such sensor."""
    stripe: bool = True
    """False: the front of the table's edge is plain, as most tables are."""
    stripe_height_m: float = positive(0.03)
    """Orange stripe on the vertical front of the table's edge. Ours."""
    object: str = one_of("can", "can", "marker")
    """What stands on the table: a green can, or a panel with a marker of the dictionary aruco-4x4."""
    marker_id: int = between(0, 0, 49)
    """The marker's number."""
    marker_m: float = between(0.08, 0.01, 0.2)
    """Its side."""
    object_diameter_m: float = positive(0.066)
    """A 0.33 l drink can."""
    object_height_m: float = positive(0.115)
    """A 0.33 l drink can."""

    gripper_forward_m: float = positive(0.28)
    """Gripper point ahead of the axle. Paper, Fig. 4: camera 0.28 m behind the point that d is measured from."""
    lower_s: float = positive(1.5)
    """Time of the lift from top to bottom. Pioneer gripper: about 0.05 m/s over 0.075 m."""
    lift_s: float = positive(1.5)
    """Time of the lift from bottom to top."""
    close_s: float = positive(1.0)
    """Time of the fingers from open to shut."""
    opening_m: float = positive(0.12)
    """Between the open fingers."""
    lift_height_m: float = positive(0.1)
    """Stroke of the lift: how far a held object rises. Ours."""
    outer_beam_m: float = between(0.01, -0.1, 0.1)
    """Break beam ahead of the gripper point. Both are broken while the object is within 0.023 m. Ours."""
    inner_beam_m: float = between(-0.01, -0.1, 0.1)
    """Break beam on the robot's side of the gripper point. Ours."""
    grip_depth_m: float = positive(0.03)
    """Fingers hold an object whose centre is within this of the gripper point, lengthwise. Ours."""

    camera_up_m: float = positive(0.45)
    """Camera above the object's centre. Paper, Fig. 4: tilt 20..43 deg is 0.95..0.20 m."""
    camera_forward_m: float = between(0.0, -0.5, 0.5)
    """Camera ahead of the axle."""
    camera_left_m: float = between(0.0, -0.5, 0.5)
    """Camera to the left of the robot's axis."""
    camera_yaw_rad: float = between(0.0, -0.5, 0.5)
    """Direction of the camera at pan 0."""
    pan_limit_rad: float = positive(100 * DEG)
    """Pan reaches +- this. Canon VC-C4 manual."""
    tilt_limit_rad: float = between(90 * DEG, 0.1, 90 * DEG)
    """Tilt reaches 0 .. this. Canon VC-C4 manual."""
    pan_rate_radps: float = positive(800 * 0.1125 * DEG)
    """Fastest pan: 800 steps a second. Canon VC-C4 command manual."""
    tilt_rate_radps: float = positive(622 * 0.1125 * DEG)
    """Fastest tilt: 622 steps a second. Canon VC-C4 command manual."""
    head_lag_s: float = not_negative(0.04)
    """Time constant of both axes. Ours."""
    head_hold_s: float = positive(0.5)
    """A command's rates are followed for this long after its frame, then the head stands still. Ours."""
    home_tilt_rad: float = between(15 * DEG, 0.0, 90 * DEG)
    """Tilt at the start of a run; pan is 0."""
    encoder_step_rad: float = not_negative(0.1125 * DEG)
    """Resolution of both encoders; 0 = exact. Canon VC-C4 command manual."""
    encoder_noise_rad: float = not_negative(0.03 * DEG)
    """Standard deviation of both encoders before rounding. Ours."""

    width_px: int = ruled(320, "320 or 640", lambda value: value in {320, 640})
    """Image width; the height is 3/4 of it."""
    focal_px: float = between(364.0, 100.0, 2000.0)
    """Focal length at 320 pixels, scaled with the width. Canon VC-C4 at its widest: 47.5 deg."""
    exposure_s: float = between(0.02, 0.0, 0.1)
    """Time that motion blurs the image over; 0 = no blur. One PAL field."""
    noise_grey: float = between(3.0, 0.0, 50.0)
    """Standard deviation of each pixel and colour, of 255. Ours."""
    light_falloff: float = between(0.25, 0.0, 0.9)
    """How much darker the darkest corner of the image is than the brightest. Ours."""
    brightness: float = between(1.0, 0.0, 2.0)
    """Factor on all colours; 1 = as painted, clipped at 2."""
    light: float = between(1.0, 0.01, 16.0)
    """The lamp's light against that for which the exposure was fixed."""
    lamp_k: float = between(4000.0, 2000.0, 8000.0)
    """The lamp's colour temperature; the camera's white balance is fixed at 4000 K."""
    distractors: bool = True
    """Coloured things on table, wall and floor that are not the object."""
    jpeg_quality: int = between(80, 1, 100)
    """As OpenCV counts it."""

    @property
    def height_px(self) -> int:
        """Image height."""
        return self.width_px * 3 // 4

    @property
    def scaled_focal_px(self) -> float:
        """Focal length at the image's own width."""
        return self.focal_px * self.width_px / 320.0

    @property
    def table_z_m(self) -> float:
        """Table top below the object's centre (negative)."""
        return -0.5 * self.object_height_m

    @property
    def stripe_z_m(self) -> float:
        """Middle of the stripe below the object's centre (negative)."""
        return self.table_z_m - 0.5 * self.stripe_height_m

    @property
    def frame_ns(self) -> int:
        """Time between frames."""
        return 1_000_000_000 // self.frame_hz
